// SIGINT, SIGTERM and SIGUSR1 (sent by batch systems before their time limit) ask for a clean end; the
// second one ends at once, unless it comes within a second: batch systems and shells signal every process of
// a job, and those pass it on. Both exit with 128 + the signal's number.
#pragma once

namespace polar::cli {

void handle_signals();

/// The signal that was received first, 0 when none was.
int received_signal();

}  // namespace polar::cli

// The one line on stderr and the exit code that an exception becomes.
#pragma once

namespace polar::cli {

/// Reports the exception that is being handled and returns its exit code. Takes no memory: there may be none.
/// An exception that nobody can catch, from a library's own thread, a destructor or before main, ends the
/// program with the same line and code.
int report_exception();

/// To be called with main's return value: an exit() before it is one of a library that found no way on.
int ended(int code);

}  // namespace polar::cli

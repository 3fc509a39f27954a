// What a run ran on.
#pragma once

#include <string>

namespace polar::pipeline {

/// "Intel(R) Xeon(R) ..., 2 threads (avx512), 7.8 GB, Linux 6.1 x86_64"; what the system does not tell is
/// left out.
std::string machine_text();

}  // namespace polar::pipeline

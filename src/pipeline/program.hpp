// Another program, started and waited for.
#pragma once

#include <string>
#include <vector>

namespace polar::pipeline {

struct ProgramEnd {
  int code = 0;        // 128 + n where signal n ended it
  std::string output;  // what it printed
  std::string errors;
};

/// Finds it along PATH, without a shell. Throws smlm::Error (resource) where it cannot be started.
ProgramEnd run_program(const std::vector<std::string>& words);

}  // namespace polar::pipeline

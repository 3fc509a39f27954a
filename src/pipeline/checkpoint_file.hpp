// A checkpoint as bytes: a readable head that says whose it is, a checksum over everything, the states.
#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace polar::pipeline {

/// Whose states they are: none of any other computation may be mixed with them.
struct ComputationIdentity {
  std::string program;        // with its commit
  std::string input;          // hash of everything that is read
  std::string configuration;  // hash of the effective one
};

struct CheckpointContent {
  ComputationIdentity identity;
  std::string instructions;  // of the kernels; others may differ in the last bits
  std::uint64_t number = 0;  // counts the checkpoints of a run
  std::map<std::string, std::string> states;
};

constexpr const char* kComputeAgain = "give --overwrite to compute again";

std::string format_checkpoint(const CheckpointContent& content);

/// Throws smlm::Error (input) that names `path` and what is wrong: truncated, damaged, of another format.
CheckpointContent parse_checkpoint(const std::string& bytes, const std::string& path);

/// Throws smlm::Error (input) that names the first part of the identity that differs.
void require_same_computation(const CheckpointContent& content, const ComputationIdentity& identity,
                              const std::string& path);

}  // namespace polar::pipeline

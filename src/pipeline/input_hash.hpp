#pragma once

#include <string>
#include <vector>

namespace polar::pipeline {

struct InputHash {
  std::string files, configuration;  // each by itself
  std::string both;                  // names the computation
  std::vector<std::string> sha256;   // of each file, so that others can tell it
};

/// FNV-1a (64 bits; G. Fowler, L. C. Noll, K.-P. Vo) over the files' content, in their order, and over
/// `configuration`. Tells a changed input from an unchanged one; it is no protection against an adversary.
InputHash input_hash(const std::vector<std::string>& files, const std::string& configuration);

}  // namespace polar::pipeline

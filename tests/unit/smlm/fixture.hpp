// What the tests of smlm share: a folder that goes away, and the error a call must throw.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "smlm/error.hpp"

namespace smlm::test {

class TemporaryFolder : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (std::filesystem::temp_directory_path() / "smlm_test_XXXXXX").string();
    ASSERT_NE(::mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string write(const std::string& name, const std::string& content) const {
    std::ofstream(path(name), std::ios::binary) << content;
    return path(name);
  }
  std::size_t files_in_folder() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder_), {}));
  }

  std::filesystem::path folder_;
};

/// The error that `call` throws; a failure with code 0 when it throws none.
template <class Call>
Error error_of(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return error;
  }
  ADD_FAILURE() << "no smlm::Error was thrown";
  return Error(Fault::usage, "", "");
}

/// A real file that is not part of the project; empty when it is absent, and the test says it was skipped.
inline std::string shared_file(const std::string& name) {
  const std::string file = std::string(POLAR_SHARED_DATA) + "/" + name;
  return std::filesystem::exists(file) ? file : std::string();
}

}  // namespace smlm::test

#define SMLM_SHARED_FILE(variable, name)                        \
  const std::string variable = ::smlm::test::shared_file(name); \
  if (variable.empty()) GTEST_SKIP() << name << " is not here"

#include "smlm/atomic_file.hpp"

#include <gmock/gmock.h>

#include <iterator>

#include "fixture.hpp"

namespace smlm {
namespace {

using ::testing::HasSubstr;
using AtomicFileTest = test::TemporaryFolder;

std::string content_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST_F(AtomicFileTest, CommitReplacesTheOldFile) {
  const std::string file = write("a.txt", "old");
  write_file_atomically(file, "new");
  EXPECT_EQ(content_of(file), "new");
  EXPECT_EQ(files_in_folder(), 1u);
}

TEST_F(AtomicFileTest, WithoutCommitTheOldFileStaysAndNothingElseIsLeft) {
  const std::string file = write("a.txt", "old");
  {
    const AtomicFile atomic(file);
    std::ofstream(atomic.temporary_path()) << "half";
    EXPECT_EQ(files_in_folder(), 2u);
  }
  EXPECT_EQ(content_of(file), "old");
  EXPECT_EQ(files_in_folder(), 1u);
}

TEST_F(AtomicFileTest, TwoWritersOfOneNameDoNotShareATemporaryFile) {
  const AtomicFile first(path("a"));
  const AtomicFile second(path("a"));
  EXPECT_NE(first.temporary_path(), second.temporary_path());
}

TEST_F(AtomicFileTest, MissingFolderIsAnIoErrorThatNamesThePath) {
  const Error error = test::error_of([&] { write_file_atomically(path("none/a"), "x"); });
  EXPECT_EQ(error.fault(), Fault::io);
  EXPECT_THAT(error.what(), HasSubstr("none/a"));
}

TEST_F(AtomicFileTest, AFolderUnderTheFinalNameIsRefusedAndLeavesNoTemporaryFile) {
  std::filesystem::create_directory(path("taken"));
  EXPECT_EQ(test::error_of([&] { write_file_atomically(path("taken"), "x"); }).fault(), Fault::io);
  EXPECT_EQ(files_in_folder(), 1u);
}

}  // namespace
}  // namespace smlm

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "pipeline/checkpoint_store.hpp"
#include "smlm/error.hpp"
#include "support/temporary_directory.hpp"

namespace polar::pipeline {
namespace {

using ::testing::HasSubstr;

const ComputationIdentity kIdentity = {"polar 1", "files", "configuration"};

std::string content(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

template <class Call>
std::string input_fault(const Call& call) {
  try {
    call();
  } catch (const smlm::Error& e) {
    EXPECT_EQ(e.fault(), smlm::Fault::input);
    return e.what();
  }
  ADD_FAILURE() << "was accepted";
  return {};
}

class Notes : public Progress {
 public:
  void note(const std::string& line) override { all += line + "\n"; }
  std::string all;
};

class CheckpointTest : public ::testing::Test {
 protected:
  CheckpointTest() : directory_(folder_.path("out"), {true, false}) {
    CheckpointStore store(directory_, kIdentity);
    store.keep("a", "first");
    store.flush();
    store.keep("b", std::string(3000, 'b'));
    store.flush();  // the first stands in checkpoint.2, the second in checkpoint.1
  }
  // What a later run finds.
  std::optional<std::string> found(const std::string& state,
                                   const ComputationIdentity& identity = kIdentity) {
    CheckpointStore store(directory_, identity);
    EXPECT_TRUE(store.resume(notes_));
    return store.load(state);
  }
  std::string newest() const { return directory_.file("checkpoint.1"); }
  std::string earlier() const { return directory_.file("checkpoint.2"); }
  static void write(const std::string& file, const std::string& bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
  }

  support::TemporaryDirectory folder_;
  OutputDirectory directory_;
  Notes notes_;
};

TEST_F(CheckpointTest, TheNewestIsFound) {
  EXPECT_EQ(found("a"), "first");
  EXPECT_EQ(found("b"), std::string(3000, 'b'));
  EXPECT_EQ(found("c"), std::nullopt);
  EXPECT_THAT(notes_.all, HasSubstr("continuing from " + newest()));
}

TEST_F(CheckpointTest, NoLengthThatIsCutOffIsRead) {
  const std::string whole = content(newest());
  EXPECT_EQ(parse_checkpoint(whole, "file").states.size(), 2u);
  for (std::size_t bytes = 0; bytes < whole.size(); ++bytes)
    EXPECT_THAT(input_fault([&] { parse_checkpoint(whole.substr(0, bytes), "file"); }),
                HasSubstr("checkpoint"));
}

TEST_F(CheckpointTest, NoFlippedBitIsRead) {
  const std::string whole = content(newest());
  for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
    std::string bytes = whole;
    bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ (1 << (bit % 8)));
    input_fault([&] { parse_checkpoint(bytes, "file"); });
  }
  input_fault([&] { parse_checkpoint(whole + "x", "file"); });
}

TEST_F(CheckpointTest, ADamagedNewestFallsBackAndSaysSo) {
  const std::string whole = content(newest());
  write(newest(), whole.substr(0, whole.size() - 1));
  EXPECT_EQ(found("b"), std::nullopt);
  EXPECT_EQ(found("a"), "first");
  EXPECT_THAT(notes_.all, HasSubstr("truncated"));
  EXPECT_THAT(notes_.all, HasSubstr("continuing from " + earlier()));
  write(earlier(), "polar-smlm checkpoint 2\n");
  CheckpointStore store(directory_, kIdentity);
  EXPECT_THAT(input_fault([&] { store.resume(notes_); }), HasSubstr("--overwrite"));
}

TEST_F(CheckpointTest, OfAnotherComputationIsRefusedWithTheReason) {
  EXPECT_THAT(input_fault([&] {
                found("a", {"polar 2", "files", "configuration"});
              }),
              HasSubstr("another version"));
  EXPECT_THAT(input_fault([&] {
                found("a", {"polar 1", "other", "configuration"});
              }),
              HasSubstr("another input"));
  EXPECT_THAT(input_fault([&] {
                found("a", {"polar 1", "files", "other"});
              }),
              HasSubstr("another configuration"));
}

TEST_F(CheckpointTest, DroppedStatesAreGoneAndRemovedFilesToo) {
  CheckpointStore store(directory_, kIdentity);
  ASSERT_TRUE(store.resume(notes_));
  PartOfCheckpoint part(store, "part");
  part.keep("a 1", "x");
  part.keep("b", "y");
  EXPECT_EQ(part.load("a 1"), "x");
  EXPECT_EQ(store.load("part/b"), "y");
  part.drop("a");
  EXPECT_EQ(part.load("a 1"), std::nullopt);
  EXPECT_EQ(part.load("b"), "y");
  EXPECT_EQ(store.load("a"), "first");
  store.remove();
  EXPECT_FALSE(std::filesystem::exists(newest()) || std::filesystem::exists(earlier()));
  EXPECT_FALSE(CheckpointStore(directory_, kIdentity).resume(notes_));
}

}  // namespace
}  // namespace polar::pipeline

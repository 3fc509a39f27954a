#include "polar/model/weights_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include "model/half.hpp"
#include "model/parameters.hpp"
#include "polar/core/sha256.hpp"
#include "smlm/error.hpp"
#include "smlm/h5/file.hpp"

namespace polar {
namespace {

class WeightsFileTest : public testing::Test {
 protected:
  void SetUp() override {
    path_ = (std::filesystem::temp_directory_path() /
             (std::string("polar_weights_") + testing::UnitTest::GetInstance()->current_test_info()->name() +
              ".h5"))
                .string();
  }
  void TearDown() override { std::filesystem::remove(path_); }
  std::string refusal() const {
    try {
      read_weights(path_);
    } catch (const smlm::Error& e) {
      return e.what();
    }
    return "";
  }
  std::string path_;
};

PointNetWeights some_weights() { return folded(initial_parameters(8), initial_moments()); }

TEST_F(WeightsFileTest, singlePrecisionComesBackBitForBit) {
  const PointNetWeights weights = some_weights();
  const std::string hash = write_weights(path_, weights, Precision::single, "a test");
  const WeightsFile file = read_weights(path_);
  EXPECT_EQ(file.sha256, hash);
  EXPECT_EQ(file.about, "a test");
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(file.weights.encoder[i].weight, weights.encoder[i].weight);
    EXPECT_EQ(file.weights.encoder[i].bias, weights.encoder[i].bias);
    EXPECT_EQ(file.weights.decoder[i].weight, weights.decoder[i].weight);
    EXPECT_EQ(file.weights.decoder[i].bias, weights.decoder[i].bias);
  }
}

TEST_F(WeightsFileTest, halfPrecisionRoundsOnceAndHashesWhatItHolds) {
  const PointNetWeights weights = some_weights();
  const std::string hash = write_weights(path_, weights, Precision::half, "");
  const WeightsFile file = read_weights(path_);
  EXPECT_EQ(file.sha256, hash);
  const RowMatrixXf difference = file.weights.decoder[2].weight - weights.decoder[2].weight;
  EXPECT_GT(difference.cwiseAbs().maxCoeff(), 0);
  // Half of the last of 11 bits.
  EXPECT_LE(difference.cwiseAbs().maxCoeff(), weights.decoder[2].weight.cwiseAbs().maxCoeff() / 2048);
  EXPECT_EQ(write_weights(path_, file.weights, Precision::half, ""), hash);
}

TEST_F(WeightsFileTest, refusesDamageAndOtherFiles) {
  const PointNetWeights weights = some_weights();
  write_weights(path_, weights, Precision::single, "");
  {  // one bit of one number
    smlm::h5::File h5 = smlm::h5::File::open(path_);
    const auto numbers = h5.read<float>("/decoder/1/bias");
    const auto bytes = std::string(reinterpret_cast<const char*>(numbers.data()), 64);
    h5.close();
    std::fstream raw(path_, std::ios::in | std::ios::out | std::ios::binary);
    std::string all((std::istreambuf_iterator<char>(raw)), {});
    raw.clear();
    raw.seekp(static_cast<std::streamoff>(all.size() / 2));
    raw.put(static_cast<char>(all[all.size() / 2] ^ 1));
  }
  EXPECT_NE(refusal(), "");
  {
    smlm::h5::File h5 = smlm::h5::File::create(path_);
    h5.write("/points", std::vector<float>{1, 2});
    h5.close();
  }
  EXPECT_NE(refusal().find("attribute `format` is missing"), std::string::npos) << refusal();
  {
    smlm::h5::File h5 = smlm::h5::File::create(path_);
    h5.write_string_attribute("/", "format", "polar autoencoder");
    h5.write_attribute("/", "version", std::int32_t{2});
    for (const char* name : {"precision", "sha256", "about"}) h5.write_string_attribute("/", name, "half");
    h5.close();
  }
  EXPECT_NE(refusal().find("version 2"), std::string::npos) << refusal();
  std::ofstream(path_) << "no HDF5";
  EXPECT_NE(refusal(), "");
}

TEST_F(WeightsFileTest, refusesAnotherNetworkAndNumbersThatAreNone) {
  PointNetWeights weights = some_weights();
  weights.decoder[2].bias.conservativeResize(7);
  write_weights(path_, weights, Precision::single, "");
  EXPECT_NE(refusal().find(path_ +
                           ": decoder layer 2: is 3072 x 1024 with 7 biases, expected 3072 x 1024 with 3072"),
            std::string::npos)
      << refusal();
  weights = some_weights();
  weights.encoder[1].weight(3, 3) = std::numeric_limits<float>::quiet_NaN();
  write_weights(path_, weights, Precision::single, "");
  EXPECT_NE(refusal().find(path_ + ": encoder layer 1: holds a value that is not finite"), std::string::npos)
      << refusal();
}

TEST(Sha256, agreesWithTheStandardsExamples) {
  const auto of = [](const std::string& text) { return sha256(text.data(), text.size()); };
  EXPECT_EQ(of(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(of("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(of("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(of(std::string(1000000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Half, roundsToNearestEvenAndKeepsSpecialValues) {
  EXPECT_EQ(half_from_float(1.0f), 0x3c00);
  EXPECT_EQ(half_from_float(-2.0f), 0xc000);
  EXPECT_EQ(half_from_float(1.0f + 0x1p-11f), 0x3c00);  // a tie, to even
  EXPECT_EQ(half_from_float(1.0f + 3 * 0x1p-11f), 0x3c02);
  EXPECT_EQ(half_from_float(1e6f), 0x7c00);
  EXPECT_EQ(half_from_float(0x1p-24f), 0x0001);  // the smallest subnormal
  EXPECT_EQ(float_from_half(0x7bff), 65504.0f);
  EXPECT_TRUE(std::isnan(float_from_half(half_from_float(std::numeric_limits<float>::quiet_NaN()))));
  for (std::uint32_t pattern = 0; pattern < 0x7c00; ++pattern)
    ASSERT_EQ(half_from_float(float_from_half(static_cast<std::uint16_t>(pattern))), pattern);
}

}  // namespace
}  // namespace polar

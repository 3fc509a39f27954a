#include "polar/pipeline/train_config.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "smlm/error.hpp"

namespace polar {
namespace {

TEST(TrainConfig, defaultFileHoldsEveryKeyWithItsDefault) {
  TrainOptions options = load_train_options(POLAR_SOURCE_DIR "/configs/train.yaml", {});
  EXPECT_EQ(options.weights, POLAR_SOURCE_DIR "/configs/weights.h5");
  options.weights = TrainOptions{}.weights;
  const std::string text = train_options_text(TrainOptions{});
  EXPECT_EQ(train_options_text(options), text);
  // Every key that is written stands in the file.
  std::ifstream in(POLAR_SOURCE_DIR "/configs/train.yaml");
  const std::string file((std::istreambuf_iterator<char>(in)), {});
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t colon = text.find(':', begin), end = text.find('\n', begin);
    EXPECT_NE(file.find("\n" + text.substr(begin, colon - begin) + ":"), std::string::npos)
        << text.substr(begin, end - begin);
    begin = end + 1;
  }
}

TEST(TrainConfig, overridesWinAndFaultsAreNamed) {
  const std::string path = POLAR_SOURCE_DIR "/configs/train.yaml";
  EXPECT_EQ(load_train_options(path, {"training.steps=7"}).steps, 7);
  const auto message = [&](const std::string& override_) {
    try {
      load_train_options(path, {override_});
    } catch (const smlm::Error& e) {
      EXPECT_EQ(e.exit_code(), 2);
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_NE(message("training.step=7").find("steps"), std::string::npos) << message("training.step=7");
  EXPECT_NE(message("training.dropout=1").find("dropout"), std::string::npos);
  EXPECT_NE(message("degradation.max_sigma=wide").find("max_sigma"), std::string::npos);
}

}  // namespace
}  // namespace polar

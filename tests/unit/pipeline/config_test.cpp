#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "pipeline/config/nearest.hpp"
#include "pipeline/config/node.hpp"
#include "polar/pipeline/simulate_run.hpp"
#include "smlm/error.hpp"
#include "support/temporary_directory.hpp"

namespace polar {
namespace {

using ::testing::HasSubstr;

class SimulateConfigFile : public ::testing::Test {
 protected:
  std::string write(const std::string& text) {
    std::ofstream(directory_.path("c.yaml")) << text;
    return directory_.path("c.yaml");
  }
  SimulateConfig load(const std::string& text, const std::vector<std::string>& overrides = {}) {
    return load_simulate_config(write(text), overrides);
  }
  void expect_fault(const std::string& text, const std::string& part,
                    const std::vector<std::string>& overrides = {}) {
    try {
      load(text, overrides);
      ADD_FAILURE() << "accepted: " << text.substr(0, 200);
    } catch (const smlm::Error& e) {
      EXPECT_EQ(e.exit_code(), 2);
      EXPECT_THAT(e.what(), HasSubstr(part));
    }
  }
  support::TemporaryDirectory directory_;
};

TEST_F(SimulateConfigFile, DefaultFileEqualsTheStructs) {
  const SimulateConfig shipped = load_simulate_config(POLAR_SOURCE_DIR "/configs/simulate.yaml", {});
  SimulateConfig defaults;
  defaults.directory = shipped.directory;  // resolved against the file's folder
  EXPECT_EQ(simulate_config_text(shipped), simulate_config_text(defaults));
  // Every key is written out: taking the shipped text as a list of keys, none is missing.
  std::ifstream in(POLAR_SOURCE_DIR "/configs/simulate.yaml");
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  pipeline::Node written = pipeline::parse_yaml(text, "shipped");
  pipeline::Node effective = pipeline::parse_yaml(simulate_config_text(defaults), "effective");
  for (const auto& [section, keys] : effective.entries)
    for (const auto& [key, value] : keys.entries) {
      ASSERT_NE(written.find(section), nullptr) << section;
      EXPECT_NE(written.find(section)->find(key), nullptr) << section << "." << key;
    }
}

TEST_F(SimulateConfigFile, EffectiveTextReadsBack) {
  const SimulateConfig a = load(
      "structure: {kind: ring, units: 6}\nsimulation:\n  sigma_xy_nm: 0.1\n  visibility: [0.25, 0.75]\n"
      "output:\n  directory: \"a \\\"b\\\" c\"\n");
  EXPECT_EQ(a.structure.units, 6);
  EXPECT_EQ(a.simulation.sigma_xy_nm, (Range{0.1, 0.1}));
  EXPECT_EQ(a.directory, directory_.path("a \"b\" c"));
  EXPECT_EQ(simulate_config_text(load(simulate_config_text(a))), simulate_config_text(a));
}

TEST_F(SimulateConfigFile, OverridesWin) {
  const SimulateConfig a = load("simulation: {seed: 3}\n", {"simulation.seed=4", "simulation.points=[5, 6]"});
  EXPECT_EQ(a.simulation.seed, 4u);
  EXPECT_EQ(a.simulation.points, (Range{5, 6}));
  EXPECT_EQ(load("", {"structure.kind=cube"}).structure.kind, "cube");
}

TEST_F(SimulateConfigFile, FaultsNameTheKeyAndTheNearestOne) {
  expect_fault("simulation:\n  particels: 3\n",
               "c.yaml:2: unknown key 'simulation.particels': did you mean 'simulation.particles'?");
  expect_fault("simulaton: {}\n", "did you mean 'simulation'?");
  expect_fault("simulation:\n  seed: 1\n  seed: 2\n", "c.yaml:3: key 'seed' occurs twice");
  expect_fault("simulation: {seed: -1}\n", "simulation.seed is '-1'");
  expect_fault("simulation: {seed: 0x10}\n", "whole number");
  expect_fault("simulation: {seed: 1e3}\n", "whole number");
  expect_fault("simulation: {seed: \"1\"}\n", "whole number");
  expect_fault("simulation: {outlier_fraction: .nan}\n", "a number");
  expect_fault("simulation: {outlier_fraction: 1,5}\n", "");
  expect_fault("simulation: {planar: no}\n", "true or false");
  expect_fault("simulation: {seed: [1]}\n", "a list");
  expect_fault("simulation: {points: [1, 2, 3]}\n", "[low, high]");
  expect_fault("simulation: 3\n", "simulation is '3'");
  expect_fault("- 1\n", "map of sections");
  expect_fault("a: [1\n", "not valid YAML");
  expect_fault("a: &x 1\nb: *x\n", "anchor");
  expect_fault("simulation: {}\n---\nsimulation: {}\n", "second YAML document");
  expect_fault("structure: {kind: piramid}\n", "expected nuclear_pore");
  expect_fault("", "did you mean 'simulation.seed'?", {"simulation.seeds=1"});
  expect_fault("", "expected section.key=value", {"simulation.seed"});
}

TEST_F(SimulateConfigFile, BombsAreRefusedQuickly) {
  expect_fault(std::string(100000, '['), "c.yaml:1");
  expect_fault("a: " + std::string(40, '[') + std::string(40, ']'), "nested deeper");
  std::string dashes;
  for (int i = 0; i < 100000; ++i) dashes += "- ";
  expect_fault(dashes, "nested deeper");
  std::string laughs = "a: &a [x, x]\n";
  for (char c = 'b'; c < 'z'; ++c)
    laughs += std::string(1, c) + ": &" + c + " [*" + char(c - 1) + ", *" + char(c - 1) + "]\n";
  expect_fault(laughs, "anchor");
  expect_fault(std::string((1 << 20) + 1, '#'), "larger than");
}

TEST_F(SimulateConfigFile, MissingFileAndFolder) {
  EXPECT_THROW(load_simulate_config(directory_.path("none.yaml"), {}), smlm::Error);
  EXPECT_THROW(load_simulate_config(directory_.path(), {}), smlm::Error);
}

TEST(NearestWord, FewestEdits) {
  EXPECT_EQ(pipeline::nearest_word("serch", {"seed", "search", "starts"}), "search");
  EXPECT_EQ(pipeline::nearest_word("x", {}), "");
}

}  // namespace
}  // namespace polar

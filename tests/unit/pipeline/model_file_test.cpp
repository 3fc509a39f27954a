#include "pipeline/model_file.hpp"

#include <gtest/gtest.h>

#include "smlm/error.hpp"

namespace polar::pipeline {
namespace {

const Eigen::Matrix3Xd kNoSites(3, 0);
constexpr const char* kRing = R"(name: mine
parameters:
  radius: {unit: nm, start: extent, bounds: [1, 100], about: of it}
parts:
  - ring: {radius: radius, z: radius / 2}
)";

std::string fault(const std::string& text, const Eigen::Matrix3Xd& site_nm = kNoSites) {
  try {
    parse_model(text, "m.yaml", site_nm);
  } catch (const smlm::Error& e) {
    EXPECT_EQ(e.fault(), smlm::Fault::usage);
    return e.what();
  }
  return "";
}

std::string replaced(std::string text, const std::string& a, const std::string& b) {
  return text.replace(text.find(a), a.size(), b);
}

TEST(ModelFile, IsReadWithItsFormulas) {
  const fitting::GeometricModel m = parse_model(kRing, "m.yaml", kNoSites);
  ASSERT_EQ(m.names(), (std::vector<std::string>{"width", "background", "radius"}));
  EXPECT_EQ(m.parameter[2].unit, "nm");
  EXPECT_DOUBLE_EQ(m.parameter[2].start[0].at(std::vector<double>{40}), 40);
  ASSERT_EQ(m.part.size(), 1u);
  EXPECT_DOUBLE_EQ(m.part[0].placement[2].at(std::vector<double>{3, 0, 50}), 25);
}

TEST(ModelFile, FaultsNameLineAndKey) {
  EXPECT_EQ(fault(replaced(kRing, "radius: radius,", "radius: radios,")),
            "m.yaml:5: parts[1].ring.radius is no formula: 'radios': 'radios' is not known (known: width, "
            "background, radius)");
  EXPECT_NE(fault(replaced(kRing, "[1, 100]", "[100, 1]"))
                .find("m.yaml:3: parameters.radius.bounds is not [low, high] with low below high"),
            std::string::npos);
  EXPECT_NE(fault(replaced(kRing, "bounds", "bound"))
                .find("m.yaml:3: parameters.radius.bound is not known: did you mean 'bounds'?"),
            std::string::npos);
  EXPECT_NE(fault(replaced(kRing, "- ring", "- rings"))
                .find("m.yaml:5: parts[1].rings is not known: did you mean 'ring'?"),
            std::string::npos);
  EXPECT_NE(fault(replaced(kRing, "radius: radius, ", "")).find("parts[1].ring.radius is missing"),
            std::string::npos);
  EXPECT_NE(
      fault("name: x\nparameters: {}\nparts: []\n").find("m.yaml:3: parts is not a list of 1 to 64 parts"),
      std::string::npos);
  EXPECT_NE(fault(replaced(kRing, "  radius:", "  pi:")).find("parameters.pi is no name for a quantity"),
            std::string::npos);
  EXPECT_NE(fault("name: x\nparameters: {}\nparts:\n  - sites: {scale: 1}\n")
                .find("parts[1].sites needs sites: name a table"),
            std::string::npos);
  EXPECT_NE(fault(replaced(kRing, "ring: {", "ring: {units: 2.5, ")).find("units is no whole number"),
            std::string::npos);
}

TEST(ModelFile, ShippedOnesAreModels) {
  const std::vector<std::string> names = shipped_models();
  EXPECT_GE(names.size(), 6u);
  for (const std::string& name : names) {
    const fitting::GeometricModel m = load_model(name, Eigen::Matrix3Xd::Identity(3, 3));
    EXPECT_EQ(m.name, name);
    for (const auto& p : m.parameter) EXPECT_FALSE(p.about.empty()) << name << ": " << p.name;
  }
}

TEST(ModelFile, HoldsParameters) {
  fitting::GeometricModel m = parse_model(kRing, "m.yaml", kNoSites);
  hold_parameter(m, "radius=42");
  EXPECT_TRUE(m.parameter[2].fixed);
  EXPECT_DOUBLE_EQ(m.parameter[2].start[0].at(std::vector<double>{1}), 42);
  EXPECT_THROW(hold_parameter(m, "radius=420"), smlm::Error);
  EXPECT_THROW(hold_parameter(m, "diameter"), smlm::Error);
}

TEST(ModelFile, UnknownModelsAreSaid) {
  try {
    load_model("no_such_model", kNoSites);
    FAIL();
  } catch (const smlm::Error& e) {
    EXPECT_NE(std::string(e.what()).find("shipped: cylinder, nuclear_pore, ring"), std::string::npos);
  }
}

}  // namespace
}  // namespace polar::pipeline

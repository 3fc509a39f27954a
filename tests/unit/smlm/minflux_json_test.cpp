#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fixture.hpp"
#include "smlm/table_reader.hpp"

namespace smlm {
namespace {

using ::testing::HasSubstr;

class MinfluxJson : public test::TemporaryFolder {};

// Six localisations of one trace; the last iteration counts, an invalid one does not.
std::string classic() {
  std::string text = "[";
  for (int i = 0; i < 6; ++i)
    text += R"({"itr":[{"loc":[0,0,0],"eco":1},{"loc":[)" + std::to_string(i) + "e-9,2e-9," +
            std::to_string(i % 2) + R"(e-8],"eco":70}],"tid":5,"vld":true,"tim":0.5},)";
  return text + R"({"itr":[{"loc":[1,1,1],"eco":2}],"tid":5,"vld":false,"tim":1}])";
}

TEST_F(MinfluxJson, LastIterationInMetresWithTheSpreadOfItsTrace) {
  const std::string file = write("a.json", classic());
  ReadOptions options;
  options.minflux_z_factor = 0.5;
  const LocalisationTable t = read_table(file, options);
  EXPECT_EQ(t.formats, std::vector<std::string>{"minflux_json"});
  ASSERT_EQ(t.size(), 6u);
  EXPECT_NEAR(t.position_nm[3][0], 3, 1e-9);
  EXPECT_NEAR(t.position_nm[3][1], 2, 1e-9);
  EXPECT_NEAR(t.position_nm[3][2], 5, 1e-9);
  ASSERT_EQ(t.rejected.size(), 1u);
  EXPECT_EQ(t.rejected[0].rows, 1u);
  EXPECT_EQ(t.rejected[0].first_row, 7u);
  std::vector<std::string> names;
  for (const ExtraColumn& c : t.extra) names.push_back(c.name);
  EXPECT_THAT(names, ::testing::UnorderedElementsAre("tid", "eco", "tim"));
  for (const ExtraColumn& c : t.extra) {
    if (c.name == "eco") {
      EXPECT_EQ(c.values[0], 70);
    }
  }
}

TEST_F(MinfluxJson, NewerFilesMarkTheFinalIteration) {
  const std::string file = write("a.json", R"([{"itr":0,"fnl":false,"loc":[9,9,9],"tid":1,"vld":true},
                          {"itr":4,"fnl":true,"loc":[1e-9,2e-9,0],"tid":1,"vld":true},
                          {"itr":4,"fnl":true,"loc":[3e-9,2e-9,0],"tid":2,"vld":true}])");
  const LocalisationTable t = read_table(file, {});
  ASSERT_EQ(t.size(), 2u);
  EXPECT_NEAR(t.position_nm[1][0], 3, 1e-9);
  EXPECT_EQ(t.source_row, (std::vector<std::uint64_t>{2, 3}));
}

TEST_F(MinfluxJson, MeasurementsInThePlaneHaveTwoNumbers) {
  const LocalisationTable t =
      read_table(write("a.json", R"([{"tid":1,"loc":[1e-9,2e-9]},{"tid":1,"loc":[3e-9,2e-9]}])"), {});
  EXPECT_TRUE(t.planar);
  EXPECT_NEAR(t.position_nm[1][0], 3, 1e-9);
  EXPECT_THAT(t.warnings, ::testing::Not(::testing::Contains(HasSubstr("minflux_z_factor"))));
}

TEST_F(MinfluxJson, WhatIsNoTableIsRefusedWithAReason) {
  const auto refused = [&](const std::string& text, const char* part) {
    ReadOptions options;
    options.format = "minflux_json";
    const std::string file = write("a.json", text);
    EXPECT_THAT(test::error_of([&] { read_table(file, options); }).what(), HasSubstr(part));
  };
  refused(R"([{"tid":1,"loc":[1]}])", "record 1 has no tid or no loc of two or three numbers");
  refused(R"([{"tid":1,"loc":[1,2]},{"tid":1,"loc":[1,2,3]}])",
          "record 2 has no tid or no loc of two or three");
  refused(R"([{"tid":1,"loc":[1,2,"a"]}])", "record 1");
  refused(R"([{"loc":[1,2,3]}])", "record 1");
  refused(R"([{"tid":1,"loc":[1,2,3]},)", "is not JSON");
  refused(R"({"tid":1})", "is not an array of records");
  refused("[[1,2]]", "is not an array of records");
  refused(std::string(5000, '['), "no MINFLUX record");
  std::string endless = R"([{"tid":1,"loc":[0)";
  for (int i = 0; i < 120000; ++i) endless += ",0";
  refused(endless + "]}]", "no MINFLUX record");
}

}  // namespace
}  // namespace smlm

#include "smlm/row_filter.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "fixture.hpp"
#include "smlm/table_reader.hpp"

namespace smlm {
namespace {

using test::error_of;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class RowFilter : public test::TemporaryFolder {
 protected:
  LocalisationTable read(const std::map<std::string, Bounds>& filters) {
    ReadOptions options;
    options.filters = filters;
    return read_table(
        write("t.csv",
              "x [nm],y [nm],z [nm],sigma_xy [nm],sigma_z [nm],intensity [photon],frame,score,note,particle\n"
              "1,2,3,5,10,500,1,0.5,a,1\n"
              "2,3,4,6,12,900,2,,a,1\n"
              "3,4,9,20,40,800,3,0.7,b,2\n"
              "4,5,6,7,14,100,4,0.9,b,3\n"),
        options);
  }
  static std::vector<std::uint64_t> rows(const LocalisationTable& table) { return table.source_row; }
};

TEST_F(RowFilter, KeepsWhatLiesWithinAllBounds) {
  const double inf = std::numeric_limits<double>::infinity();
  EXPECT_THAT(rows(read({{"photons", {500, inf}}})), ElementsAre(1, 2, 3));
  EXPECT_THAT(rows(read({{"intensity", {500, 800}}})), ElementsAre(1, 3));
  EXPECT_THAT(rows(read({{"sigma_xy_nm", {0, 15}}})), ElementsAre(1, 2, 4));
  EXPECT_THAT(rows(read({{"z_nm", {3, 4}}})), ElementsAre(1, 2));
  EXPECT_THAT(rows(read({{"sigma_z_nm", {12, 14}}, {"frame", {3, inf}}})), ElementsAre(4));
  EXPECT_THAT(rows(read({{"score", {-inf, inf}}})), ElementsAre(1, 3, 4)) << "none is no number";
}

TEST_F(RowFilter, CountsByTheFirstReason) {
  const LocalisationTable t = read({{"photons", {200, 850}}, {"sigma_xy_nm", {0, 15}}});
  ASSERT_EQ(t.rejected.size(), 3u);
  EXPECT_EQ(t.rejected[0].reason, "photons below 200");
  EXPECT_EQ(t.rejected[0].first_row, 4u);
  EXPECT_EQ(t.rejected[1].reason, "photons above 850");
  EXPECT_EQ(t.rejected[2].reason, "sigma_xy_nm above 15");
  EXPECT_EQ(t.rejected[2].rows, 1u);
  EXPECT_EQ(t.particle_names.size(), 3u) << "a particle without a row is still one";
  EXPECT_EQ(t.extra.front().values.size(), t.size());
}

TEST_F(RowFilter, AnUnknownColumnIsNamedWithThoseThatThereAre) {
  const Error unknown = error_of([&] { read({{"photon", {0, 1}}}); });
  EXPECT_EQ(unknown.exit_code(), 3);
  EXPECT_THAT(unknown.what(), HasSubstr("t.csv: has no column 'photon'"));
  EXPECT_THAT(unknown.what(), HasSubstr("intensity [photon]"));
  EXPECT_THAT(error_of([&] { read({{"note", {0, 1}}}); }).what(), HasSubstr("holds text"));
  EXPECT_THAT(error_of([&] { read({{"frame", {2, 1}}}); }).what(), HasSubstr("low bound is above"));
}

}  // namespace
}  // namespace smlm

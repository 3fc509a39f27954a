#include <gmock/gmock.h>

#include "fixture.hpp"
#include "smlm/table_reader.hpp"

namespace smlm {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class ThunderstormReader : public test::TemporaryFolder {};

const char* const header3d =
    "\"id\",\"frame\",\"x [nm]\",\"y [nm]\",\"z [nm]\",\"sigma1 [nm]\",\"sigma2 [nm]\",\"intensity "
    "[photon]\","
    "\"offset [photon]\",\"bkgstd [photon]\",\"chi2\",\"uncertainty_xy [nm]\",\"uncertainty_z [nm]\"\n";

TEST_F(ThunderstormReader, SigmaIsTheWidthOfThePsfAndNotTheUncertainty) {
  const LocalisationTable table = read_table(
      write("t.csv",
            "\"id\",\"frame\",\"x [nm]\",\"y [nm]\",\"sigma [nm]\",\"uncertainty [nm]\"\n1,1,10,20,140,8\n"),
      {});
  EXPECT_THAT(table.formats, ElementsAre("thunderstorm"));
  EXPECT_FLOAT_EQ(table.covariance_nm2[0][0], 64);
  ASSERT_EQ(table.extra.size(), 3u);
  EXPECT_EQ(table.extra[2].name, "sigma [nm]");

  const LocalisationTable without =
      read_table(write("s.csv", "\"x [nm]\",\"y [nm]\",\"sigma [nm]\"\n10,20,140\n"), {});
  EXPECT_TRUE(without.sigma_assumed);
}

TEST_F(ThunderstormReader, AnInfiniteAxialUncertaintyIsARejection) {
  const std::string rows =
      "1,1,10,20,30,1,1,1,1,1,1,5,Infinity\n2,1,10,20,31,1,1,1,1,1,1,5,9\n3,1,11,20,30,1,1,1,1,1,1,5,"
      "Infinity\n";
  const LocalisationTable table = read_table(write("t.csv", header3d + rows), {});
  EXPECT_THAT(table.source_row, ElementsAre(2));
  ASSERT_EQ(table.rejected.size(), 1u);
  EXPECT_EQ(table.rejected[0].rows, 2u);
  EXPECT_EQ(table.rejected[0].first_row, 1u);
  EXPECT_THAT(table.rejected[0].reason, HasSubstr("infinite"));
  const Error error = test::error_of([&] {
    read_table(write("u.csv", header3d + std::string("1,1,10,20,30,1,1,1,1,1,1,Infinity,5\n")), {});
  });
  EXPECT_THAT(error.what(), HasSubstr("u.csv:2:12: uncertainty is not finite"));
}

TEST_F(ThunderstormReader, UnitsOfTheHeaderAreObeyed) {
  ReadOptions options;
  options.pixel_size_nm = 80;
  const LocalisationTable table = read_table(
      write("t.csv",
            "\"frame\",\"x [px]\",\"y [um]\",\"intensity [photon]\",\"uncertainty_xy [px]\"\n1,10,2,5,0.1\n"),
      options);
  EXPECT_THAT(table.position_nm[0], ElementsAre(800, 2000, 0));
  EXPECT_FLOAT_EQ(table.covariance_nm2[0][3], 64);
}

TEST_F(ThunderstormReader, RealFiles) {
  SMLM_SHARED_FILE(three, "formats/thunderstorm_3d.csv");
  const LocalisationTable table = read_table(three, {});
  EXPECT_EQ(table.size(), 11195u);
  EXPECT_THAT(table.position_nm[0], ElementsAre(24840.78095, 20471.75758, -21.8435));
  EXPECT_FLOAT_EQ(table.covariance_nm2[0][5], 10.16F * 10.16F);
  EXPECT_FALSE(table.axial_sigma_assumed);
  SMLM_SHARED_FILE(quoted, "formats/locan_Thunderstorm_dstorm_data.csv");
  EXPECT_FLOAT_EQ(read_table(quoted, {}).covariance_nm2[0][0], 22.93255128689051F * 22.93255128689051F);
  SMLM_SHARED_FILE(challenge, "formats/smlm_challenge_MT1.N1.HD-AS.csv");
  EXPECT_TRUE(read_table(challenge, {}).axial_sigma_assumed);
}

}  // namespace
}  // namespace smlm

#include "smlm/inspect.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "fixture.hpp"
#include "smlm/table_reader.hpp"

namespace smlm {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class Inspect : public test::TemporaryFolder {
 protected:
  LocalisationTable read(const std::string& content, const ReadOptions& options = {}) const {
    return read_table(write("t.csv", content), options);
  }
};

TEST_F(Inspect, NumbersOfATable) {
  ReadOptions options;
  options.drop_nonfinite = true;
  const Inspection in =
      inspect(read("particle,x_nm,y_nm,z_nm,sigma_xy_nm,sigma_z_nm,photons\n1,0,0,0,2,6,\n1,30,40,0,4,8,7\n2,"
                   "5,5,9,3,7,8\n-1,1,1,1,3,7,9\n1,nan,1,1,3,7,9\n",
                   options));
  EXPECT_EQ(in.localisations, 4u);
  EXPECT_EQ(in.particles, 2u);
  EXPECT_EQ(in.unassigned, 1u);
  EXPECT_EQ(in.localisations_per_particle.minimum, 1);
  EXPECT_EQ(in.localisations_per_particle.maximum, 2);
  EXPECT_DOUBLE_EQ(in.particle_radius_nm.median, 25);
  EXPECT_DOUBLE_EQ(in.sigma_lateral_nm.median, 3);
  EXPECT_DOUBLE_EQ(in.sigma_axial_nm.maximum, 8);
  ASSERT_EQ(in.columns.size(), 6u);
  EXPECT_EQ(in.columns[5].name, "photons");
  EXPECT_EQ(in.columns[5].values, 3u);
  EXPECT_FALSE(in.columns[5].used);

  const auto json = nlohmann::json::parse(to_json(in));
  EXPECT_EQ(json["localisations"], 4);
  EXPECT_EQ(json["columns"][5]["median"], 8);
  EXPECT_EQ(json["rejected"][0]["rows"], 1);
  const std::string text = to_text(in);
  EXPECT_THAT(text, HasSubstr("4 localisations, 2 particles of 1 to 2"));
  EXPECT_THAT(text, HasSubstr("rejected: 1 rows, position is not finite, first row 5"));
  EXPECT_THAT(text, HasSubstr("x <- 'x_nm'"));
}

TEST_F(Inspect, ParticlesOfOneLocalisationHaveNoRadius) {
  const std::string text = to_text(inspect(read("particle,x_nm,y_nm\n1,0,0\n2,5,5\n")));
  EXPECT_THAT(text, HasSubstr("2 particles of 1 to 1 (median 1) localisations\n"));
}

TEST_F(Inspect, NamesThatAreNotUtf8DoNotBreakJson) {
  const Inspection in = inspect(read("x_nm,y_nm,\xFFname\n1,2,3\n"));
  EXPECT_TRUE(nlohmann::json::parse(to_json(in), nullptr, false).is_object());
}

TEST_F(Inspect, EmptyTablesHaveNullQuantiles) {
  const auto json = nlohmann::json::parse(to_json(inspect(read("x_nm,y_nm\n"))));
  EXPECT_TRUE(json["sigma_lateral_nm"]["median"].is_null());
}

TEST_F(Inspect, WhatLooksWrongIsSaid) {
  const std::string head = "particle,x_nm,y_nm,sigma_xy_nm\n";
  EXPECT_THAT(read(head + "1,0,0,5\n1,100,0,5\n").warnings, IsEmpty());
  EXPECT_THAT(read(head + "1,0,0,140\n1,1000,0,140\n").warnings, Contains(HasSubstr("width of a PSF")));
  EXPECT_THAT(read(head + "1,0,0,50\n1,10,0,50\n").warnings,
              Contains(HasSubstr("larger than the particles")));
  EXPECT_THAT(read(head + "1,0,0,.01\n1,.5,0,.01\n").warnings, Contains(HasSubstr("another unit")));
  EXPECT_THAT(read(head + "1,0,0,5\n1,100000,0,5\n").warnings, Contains(HasSubstr("another unit")));
}

TEST_F(Inspect, OneAxisInAnotherUnitIsSaid) {
  const std::string head = "particle,x_nm,y_nm,uncertainty_x_nm,uncertainty_y_nm\n";
  EXPECT_THAT(read(head + "1,0,0,5,6\n1,100,90,5,6\n").warnings, IsEmpty());
  EXPECT_THAT(read(head + "1,0,0,5,.006\n1,100,90,5,.006\n").warnings,
              Contains(HasSubstr("5 nm along x and 0.006 nm along y")));
  EXPECT_THAT(read(head + "1,0,0,5,6\n1,100,.09,5,6\n").warnings,
              Contains(HasSubstr("along y: is one of them in another unit? (x <- 'x_nm' (nm); y <- 'y_nm'")));
  EXPECT_THAT(read("particle,x_nm,y_nm,z_nm\n1,0,0,5\n1,99,90,5\n2,0,0,70\n2,99,90,70\n").warnings,
              Contains(HasSubstr("z is the same within most particles")));
}

TEST_F(Inspect, NumbersThatDoublesRoundAreSaid) {
  EXPECT_THAT(read("x_nm,y_nm,time\n1,2,1700000000123456789\n").warnings,
              Contains(HasSubstr("column 'time' holds numbers of more than 15 digits")));
  EXPECT_THAT(read("x_nm,y_nm,time\n1,2,900719925474099\n").warnings,
              ::testing::Not(Contains(HasSubstr("digits"))));
}

TEST_F(Inspect, RealPsfLikeUncertaintiesAreNoticed) {
  SMLM_SHARED_FILE(challenge, "formats/smlm_challenge_MT1.N1.HD-AS.csv");
  EXPECT_THAT(read_table(challenge, {}).warnings, Contains(HasSubstr("width of a PSF")));
  SMLM_SHARED_FILE(logo, "smlm/tud_logo_dol50_real_2d.csv.gz");
  EXPECT_THAT(read_table(logo, {}).warnings, Contains(HasSubstr("another unit")));
}

}  // namespace
}  // namespace smlm

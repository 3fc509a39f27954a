#include "smlm/pick.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "fixture.hpp"
#include "smlm/particle_set.hpp"
#include "smlm/table_reader.hpp"

namespace smlm {
namespace {

using ::testing::ElementsAre;

// Rings of 40 localisations about the centres, radius 50 nm, and sparse background.
LocalisationTable rings(const std::vector<Centre>& centres) {
  LocalisationTable table;
  const auto add = [&table](double x, double y) {
    table.position_nm.push_back({x, y, 0});
    table.covariance_nm2.push_back({1, 0, 0, 1, 0, 1});
    table.particle.push_back(-1);
  };
  for (int i = 0; i < 60; ++i) add(37.0 * (i * 13 % 61), 41.0 * (i * 29 % 59));
  for (const Centre& centre : centres) {
    for (int i = 0; i < 40; ++i)
      add(centre[0] + 50 * std::cos(i * 0.157), centre[1] + 50 * std::sin(i * 0.157));
  }
  return table;
}

TEST(Pick, FindsDensePlacesAndNothingElse) {
  const std::vector<Centre> truth{{300, 400}, {900, 500}, {1500, 2000}};
  LocalisationTable table = rings(truth);
  PickOptions options;
  options.radius_nm = 70;
  options.min_localisations = 20;
  const std::vector<Centre> centres = find_centres(table, options);
  ASSERT_EQ(centres.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(centres[i][0], truth[i][0], 5);
    EXPECT_NEAR(centres[i][1], truth[i][1], 5);
  }
  pick_particles(table, centres, options.radius_nm);
  EXPECT_THAT(table.particle_names, ElementsAre("1", "2", "3"));
  for (std::size_t row = 60; row < table.size(); ++row) {
    EXPECT_EQ(table.particle[row], static_cast<std::int64_t>((row - 60) / 40));
  }
}

TEST(Pick, NeighboursCloserThanTwoRadiiAreNotBothPicked) {
  PickOptions options;
  options.radius_nm = 70;
  options.min_localisations = 20;
  EXPECT_EQ(find_centres(rings({{1000, 1000}, {1120, 1000}}), options).size(), 1u);
}

TEST(Pick, OverlapsGoToTheNearestCentre) {
  LocalisationTable table = rings({});
  table.position_nm[0] = {9, 0, 0};
  table.position_nm[1] = {11, 0, 0};
  table.position_nm[2] = {-11, 0, 0};
  pick_particles(table, {{0, 0}, {20, 0}, {-500, 7}}, 15);
  EXPECT_EQ(table.particle[0], 0);
  EXPECT_EQ(table.particle[1], 1);
  EXPECT_EQ(table.particle[2], 0);
  EXPECT_EQ(table.particle_names.size(), 3u) << "a centre without localisations is still a particle";
}

class PickFromFile : public test::TemporaryFolder {};

TEST_F(PickFromFile, CentresComeFromATable) {
  const std::string field = write("f.csv", "x_nm,y_nm\n1,1\n2,2\n100,100\n101,101\n500,500\n");
  ReadOptions options;
  options.particles = "picked";
  options.pick.radius_nm = 10;
  options.pick.centres = write("c.csv", "x_um,y_um\n0.1,0.1\n0,0\n");
  const LocalisationTable table = read_table(field, options);
  EXPECT_THAT(table.particle, ElementsAre(1, 1, 0, 0, -1));
  const std::string other = write("g.csv", "x_nm,y_nm\n1,1\n");
  EXPECT_EQ(test::error_of([&] { read_tables({field, other}, options); }).fault(), Fault::usage);
  options.pick.radius_nm = 0;
  EXPECT_EQ(test::error_of([&] { read_table(field, options); }).fault(), Fault::usage);
}

TEST_F(PickFromFile, WhatKeepsParticlesFromBeingPickedIsSaid) {
  const std::string field = write("f.csv", "x_nm,y_nm,particle\n1,1,1\n2,2,1\n100,100,2\n101,101,2\n");
  ReadOptions options;
  options.particles = "picked";
  options.pick.radius_nm = 10;
  const LocalisationTable none = read_table(field, options);
  EXPECT_THAT(
      obstacle_to_registration(none)->what(),
      ::testing::HasSubstr("no place holds enough localisations to be picked: do input.pick.radius_nm"));
  options.pick.min_localisations = 2;
  const LocalisationTable two = read_table(field, options);
  EXPECT_FALSE(obstacle_to_registration(two));
  EXPECT_THAT(two.warnings,
              ::testing::Contains(::testing::HasSubstr("which input.particles: picked ignores")));
}

TEST_F(PickFromFile, ARealFieldHasItsOrigami) {
  SMLM_SHARED_FILE(field, "formats/picasso_origami_simulated_locs.hdf5");
  ReadOptions options;
  options.particles = "picked";
  options.pick.radius_nm = 80;
  options.pick.min_localisations = 100;
  const LocalisationTable table = read_table(field, options);
  EXPECT_GT(table.particle_names.size(), 50u);
  const auto assigned =
      table.size() - static_cast<std::size_t>(std::count(table.particle.begin(), table.particle.end(), -1));
  EXPECT_GT(assigned, table.size() / 2);
}

}  // namespace
}  // namespace smlm

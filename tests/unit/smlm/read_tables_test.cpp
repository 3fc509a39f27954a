#include <gmock/gmock.h>

#include <cmath>

#include "concatenate.hpp"
#include "fixture.hpp"
#include "smlm/particle_set.hpp"
#include "smlm/repetitions.hpp"
#include "smlm/table_reader.hpp"

namespace smlm {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class ReadTables : public test::TemporaryFolder {};

TEST_F(ReadTables, ParticlesOfTwoFilesNeverMerge) {
  const std::string a = write("a.csv", "particle,x_nm,y_nm,p\n0,1,2,5\n1,1,2,6\n");
  const std::string b = write("b.csv", "particle,x_nm,y_nm,q\n0,3,4,7\n");
  const ParticleSet set = group_particles(read_tables({a, b}, {}));
  ASSERT_EQ(set.particles.size(), 3u);
  EXPECT_EQ(set.particles[0].name, "a:0");
  EXPECT_EQ(set.particles[2].name, "b:0");
  EXPECT_THAT(set.particles[2].rows, ElementsAre(2u));
  EXPECT_THAT(set.table.source_file, ElementsAre(0u, 0u, 1u));
  EXPECT_THAT(set.table.source_row, ElementsAre(1u, 2u, 1u));
  ASSERT_EQ(set.table.extra.size(), 2u);
  EXPECT_TRUE(std::isnan(set.table.extra[0].values[2]));
  EXPECT_TRUE(std::isnan(set.table.extra[1].values[0]));
  EXPECT_EQ(set.table.extra[1].values[2], 7);
}

TEST_F(ReadTables, AFileCanBeAParticle) {
  std::filesystem::create_directory(path("one"));
  std::filesystem::create_directory(path("two"));
  const std::string text = "x_nm,y_nm,z_nm\n1,2,3\n1,2,4\n";
  const std::vector<std::string> files{write("one/p.csv", text), write("two/p.csv", text + "1,2,5\n"),
                                       write("q.csv", "x_nm,y_nm,z_nm\n9,9,9\n")};
  ReadOptions options;
  options.particles = "one_per_file";
  const ParticleSet set = group_particles(read_tables(files, options));
  ASSERT_EQ(set.particles.size(), 3u);
  EXPECT_EQ(set.particles[0].name, "one/p");
  EXPECT_EQ(set.particles[1].name, "two/p");
  EXPECT_EQ(set.particles[2].name, "q");
  EXPECT_FALSE(set.table.planar) << "one localisation alone has a constant z, the set has not";
}

TEST_F(ReadTables, TextColumnsOfSeveralFilesKeepTheirWords) {
  const std::string a = write("a.csv", "x_nm,y_nm,dye\n1,2,red\n");
  const std::string b = write("b.csv", "x_nm,y_nm,dye\n1,2,blue\n1,2,red\n");
  const LocalisationTable table = read_tables({a, b}, {});
  const auto word = [&](std::size_t row) {
    return table.extra[0].labels[static_cast<std::size_t>(table.extra[0].values[row])];
  };
  EXPECT_EQ(word(0), "red");
  EXPECT_EQ(word(1), "blue");
  EXPECT_EQ(word(2), "red");
}

TEST_F(ReadTables, FilesWithAndWithoutZDoNotMix) {
  const std::string a = write("a.csv", "x_nm,y_nm,z_nm\n1,2,3\n1,2,9\n");
  const std::string b = write("b.csv", "x_nm,y_nm\n1,2\n");
  EXPECT_EQ(test::error_of([&] { read_tables({a, b}, {}); }).fault(), Fault::input);
  const std::string c = write("c.csv", "x_nm,y_nm,z_nm\n5,6,0\n");
  EXPECT_TRUE(read_tables({b, c}, {}).planar) << "one row is too few to tell";
  EXPECT_FALSE(read_tables({a, c}, {}).planar);
}

TEST_F(ReadTables, TheSameDataTwiceIsFound) {
  const std::string rows = "1,10,20,3\n1,11,20,3\n1,10,25,3\n";
  const std::string head = "particle,x_nm,y_nm,sigma_xy_nm\n";
  const std::string a = write("a.csv", head + rows), b = write("b.csv", head + rows);
  EXPECT_THAT(test::error_of([&] { read_tables({a, b}, {}); }).what(), HasSubstr("b.csv: holds the same as"));
  // One row fewer is another file, and still the same particle.
  const LocalisationTable table =
      read_tables({a, write("c.csv", head + rows.substr(10) + "2,90,90,3\n2,91,95,3\n")}, {});
  const Repetitions found = find_repetitions(table);
  EXPECT_EQ(found.rows, 0u);
  EXPECT_EQ(found.particles, 1u);
  EXPECT_THAT(found.original, ElementsAre(0u, 0u, 2u));
  EXPECT_EQ(find_repetitions(read_table(write("d.csv", head + rows + rows), {})).rows, 3u);
}

TEST_F(ReadTables, FilesAreCalledAsShortlyAsTellsThemApart) {
  EXPECT_THAT(short_names({"/d/cell.csv", "/d/cell.txt", "/e/cell.csv"}),
              ElementsAre("cell.csv", "cell.txt", "cell"));
  EXPECT_THAT(short_names({"/a/b/x.csv", "/c/b/x.csv", "/a/y.csv.gz"}), ElementsAre("a/b/x", "c/b/x", "y"));
  EXPECT_THAT(short_names({"/x.csv", "/a/x.csv"}), ElementsAre("x", "a/x"));
}

TEST_F(ReadTables, RejectionsRememberTheirFile) {
  ReadOptions options;
  options.drop_nonfinite = true;
  const std::string a = write("a.csv", "x_nm,y_nm\n1,2\n");
  const std::string b = write("b.csv", "x_nm,y_nm\n1,2\nnan,2\n");
  const LocalisationTable table = read_tables({a, b}, options);
  ASSERT_EQ(table.rejected.size(), 1u);
  EXPECT_EQ(table.rejected[0].file, 1u);
  EXPECT_EQ(table.rejected[0].first_row, 2u);
}

TEST_F(ReadTables, OneWarningForManyFiles) {
  std::vector<std::string> files;
  for (int i = 0; i < 5; ++i)
    files.push_back(write("f" + std::to_string(i) + ".csv", "x_nm,y_nm\n1," + std::to_string(i) + "\n"));
  const LocalisationTable table = read_tables(files, {});
  ASSERT_EQ(table.warnings.size(), 1u);
  EXPECT_THAT(table.warnings[0], HasSubstr("and 4 more files"));
}

TEST_F(ReadTables, OddNamesAreOnlyNames) {
  for (const char* name : {"a b.csv", "-rf.csv", "new\nline.csv", "\xFF\xFE.csv", "$(touch x).csv"}) {
    EXPECT_EQ(read_table(write(name, "x_nm,y_nm\n1,2\n"), {}).size(), 1u);
  }
  std::filesystem::create_symlink(path("loop"), path("loop"));
  EXPECT_EQ(test::error_of([&] { read_table(path("loop"), {}); }).fault(), Fault::io);
  EXPECT_EQ(test::error_of([&] { read_tables({}, {}); }).fault(), Fault::usage);
  const std::string twice = path("a b.csv");
  EXPECT_EQ(test::error_of([&] { read_tables({twice, twice}, {}); }).fault(), Fault::usage);
}

TEST_F(ReadTables, WithoutParticlesTheRemedyIsNamed) {
  const LocalisationTable table = read_table(write("a.csv", "x_nm,y_nm\n1,2\n"), {});
  const Error error = test::error_of([&] { group_particles(table); });
  EXPECT_EQ(error.fault(), Fault::input);
  EXPECT_THAT(error.what(), HasSubstr("one_per_file"));
}

TEST_F(ReadTables, UnknownContentIsNamed) {
  EXPECT_THAT(test::error_of([&] { read_table(write("a.asdf", "#ASDF 1.0.0\n%YAML\n\0"), {}); }).what(),
              HasSubstr("ASDF"));
  EXPECT_THAT(test::error_of([&] {
                read_table(write("a.csv", std::string(4096, '\x01') + std::string(1, '\0')), {});
              }).what(),
              HasSubstr("no reader recognises"));
}

}  // namespace
}  // namespace smlm

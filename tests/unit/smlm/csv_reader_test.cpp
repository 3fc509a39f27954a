#include <gmock/gmock.h>
#include <zlib.h>

#include <cmath>
#include <locale>

#include "fixture.hpp"
#include "smlm/table_reader.hpp"

namespace smlm {
namespace {

using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::FloatEq;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class CsvReader : public test::TemporaryFolder {
 protected:
  LocalisationTable read(const std::string& content, const ReadOptions& options = {}) const {
    return read_table(write("t.csv", content), options);
  }
  Error refused(const std::string& content, const ReadOptions& options = {}) const {
    return test::error_of([&] { read(content, options); });
  }
};

const char* const plain = "particle,x_nm,y_nm,z_nm,sigma_xy_nm,sigma_z_nm\n7,1,2,3,0.5,1\n8,4,5,6,2,3\n";

TEST_F(CsvReader, PlainTable) {
  const LocalisationTable table = read(plain);
  ASSERT_EQ(table.size(), 2u);
  EXPECT_THAT(table.position_nm[1], ElementsAre(4, 5, 6));
  EXPECT_THAT(table.covariance_nm2[1], ElementsAre(4.F, 0.F, 0.F, 4.F, 0.F, 9.F));
  EXPECT_THAT(table.particle_names, ElementsAre("7", "8"));
  EXPECT_THAT(table.particle, ElementsAre(0, 1));
  EXPECT_THAT(table.source_row, ElementsAre(1, 2));
  EXPECT_THAT(table.formats, ElementsAre("csv"));
  EXPECT_THAT(table.warnings, IsEmpty());
  EXPECT_FALSE(table.planar || table.axial_sigma_assumed || table.sigma_assumed);
}

// The same two rows in every dialect that is accepted.
TEST_F(CsvReader, DialectsGiveTheSameTable) {
  const LocalisationTable expected = read(plain);
  std::string crlf, cr, tabs, semicolons, blanks;
  for (const char c : std::string(plain)) {
    crlf += c == '\n' ? "\r\n" : std::string(1, c);
    cr += c == '\n' ? '\r' : c;
    tabs += c == ',' ? '\t' : c;
    semicolons += c == ',' ? ';' : c;
    blanks += c == ',' ? "  " : std::string(1, c);
  }
  std::string bare(plain);
  bare.pop_back();
  std::string whole_header_quoted(plain);
  const auto end = whole_header_quoted.find('\n');
  whole_header_quoted =
      "\"particle,\"\"x_nm\"\",\"\"y_nm\"\",z_nm,sigma_xy_nm,sigma_z_nm\"" + whole_header_quoted.substr(end);
  const std::vector<std::string> dialects{crlf,
                                          cr,
                                          tabs,
                                          semicolons,
                                          blanks,
                                          bare,
                                          "\xEF\xBB\xBF" + std::string(plain),
                                          "# a comment\n\n#another\n" + std::string(plain) + "\n\n",
                                          whole_header_quoted,
                                          "\"particle\",\"x_nm\",\"y_nm\",\"z_nm\",\"sigma_xy_nm\",\"sigma_z_"
                                          "nm\"\n\"7\",\"1\", 2 ,3,.5,1e0\n8,4,5,6,2,3\n"};
  for (const std::string& text : dialects) {
    const LocalisationTable table = read(text);
    EXPECT_EQ(table.position_nm, expected.position_nm) << text;
    EXPECT_EQ(table.covariance_nm2, expected.covariance_nm2) << text;
    EXPECT_EQ(table.particle_names, expected.particle_names) << text;
  }
}

TEST_F(CsvReader, GzipIsReadWhateverItsName) {
  gzFile file = gzopen(path("t.csv").c_str(), "wb");
  gzputs(file, plain);
  gzclose(file);
  EXPECT_EQ(read_table(path("t.csv"), {}).size(), 2u);
}

TEST_F(CsvReader, TruncatedGzipIsRefused) {
  gzFile file = gzopen(path("whole.gz").c_str(), "wb");
  gzputs(file, "x_nm,y_nm\n");
  for (int i = 0; i < 100000; ++i) gzprintf(file, "%d,%d\n", i * 7919 % 10007, i);
  gzclose(file);
  std::ifstream source(path("whole.gz"), std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(source), {}};
  const Error error =
      test::error_of([&] { read_table(write("cut.gz", bytes.substr(0, bytes.size() / 2)), {}); });
  EXPECT_EQ(error.fault(), Fault::input);
  EXPECT_THAT(error.what(), HasSubstr("gzip"));
}

TEST_F(CsvReader, UnitsAreConverted) {
  ReadOptions options;
  options.pixel_size_nm = 100;
  const LocalisationTable table =
      read("x [px],y [um],z [m],uncertainty_xy [px]\n1.5,2,3e-9,0.1\n1.5,2,4e-9,0.1\n", options);
  EXPECT_THAT(table.position_nm[0], ElementsAre(150, 2000, ::testing::DoubleEq(3)));
  EXPECT_FLOAT_EQ(table.covariance_nm2[0][0], 100);
  EXPECT_FLOAT_EQ(table.covariance_nm2[0][5], 400) << "sigma_z is assumed to be twice the lateral one";
  EXPECT_TRUE(table.axial_sigma_assumed);
  const Error error = refused("x [px],y [px]\n1,2\n");
  EXPECT_EQ(error.fault(), Fault::input);
  EXPECT_THAT(error.what(), HasSubstr("input.pixel_size_nm"));
  EXPECT_THAT(refused("x [ADU],y [nm]\n1,2\n").what(), HasSubstr("'ADU'"));
}

TEST_F(CsvReader, AssumedNanometresAreSaid) {
  const LocalisationTable table = read("x,y,sigma_xy\n1,2,3\n4,5,6\n");
  ASSERT_EQ(table.warnings.size(), 2u);
  EXPECT_THAT(table.warnings[0], HasSubstr("'x', 'y' carry no unit: taken as nm"));
  EXPECT_TRUE(table.planar);
  ReadOptions options;
  options.unit = "px";
  options.pixel_size_nm = 130;
  const LocalisationTable scaled = read("x,y,sigma_xy\n1,2,.1\n4,5,.1\n", options);
  EXPECT_THAT(scaled.warnings, IsEmpty());
  EXPECT_THAT(scaled.position_nm[0], ElementsAre(130, 260, 0));
  EXPECT_FLOAT_EQ(scaled.covariance_nm2[0][0], 13.F * 13.F);
}

TEST_F(CsvReader, ColumnsCanBeNamed) {
  ReadOptions options;
  options.columns["x"] = {"first", "um", "std"};
  options.columns["y"] = {"second", "um", "std"};
  options.columns["sigma_xy"] = {"v", "nm", "variance"};
  options.columns["particle"] = {"cell", "nm", "std"};
  const LocalisationTable table = read("first,second,v,x,cell\n1,2,16,99,left\n3,4,25,99,right\n", options);
  EXPECT_THAT(table.position_nm[0], ElementsAre(1000, 2000, 0));
  EXPECT_FLOAT_EQ(table.covariance_nm2[0][0], 16);
  EXPECT_THAT(table.particle_names, ElementsAre("left", "right"));
  ASSERT_EQ(table.extra.size(), 1u);
  EXPECT_EQ(table.extra[0].name, "x");

  options.columns.erase("particle");
  options.columns["x"].name = "thrid";
  const Error error = refused("first,second,v\n1,2,16\n", options);
  EXPECT_THAT(error.what(), HasSubstr("'thrid'"));
  EXPECT_THAT(error.what(), HasSubstr("'first', 'second'"));
}

TEST_F(CsvReader, TablesWithoutHeaderAreMappedByNumber) {
  ReadOptions options;
  options.columns["x"] = {"1", "nm", "std"};
  options.columns["y"] = {"3", "nm", "std"};
  EXPECT_THAT(read("1,2,3\n4,5,6\n", options).position_nm[1], ElementsAre(4, 6, 0));
  EXPECT_THAT(refused("1,2,3\n").what(), HasSubstr("input.columns.x"));
}

TEST_F(CsvReader, FullCovariances) {
  const LocalisationTable table = read(
      "x_nm,y_nm,z_nm,sigma_xx,sigma_xy,sigma_xz,sigma_yy,sigma_yz,sigma_zz\n0,0,0,4,1,.5,5,-1,9\n0,0,1,4,1,."
      "5,5,-1,9\n");
  EXPECT_THAT(table.covariance_nm2[0], ElementsAre(4.F, 1.F, .5F, 5.F, -1.F, 9.F));
  const Error error = refused("x_nm,y_nm,z_nm,sigma_xx,sigma_xy,sigma_yy,sigma_zz\n0,0,0,4,6,5,9\n");
  EXPECT_EQ(error.fault(), Fault::input);
  EXPECT_THAT(error.what(), HasSubstr("t.csv:2:4: covariance is not positive definite"));
  const LocalisationTable lateral = read("x_nm,y_nm,z_nm,sigma_xx,sigma_yy\n0,0,0,4,6\n0,0,1,4,6\n");
  EXPECT_TRUE(lateral.axial_sigma_assumed);
  EXPECT_THAT(lateral.covariance_nm2[0], ElementsAre(4.F, 0.F, 0.F, FloatEq(6.F), 0.F, FloatEq(20.F)));
  EXPECT_THAT(refused("x_nm,y_nm,z_nm,sigma_xx,sigma_xz,sigma_yy\n0,0,0,4,1,6\n").what(),
              HasSubstr("sigma_zz"));
}

TEST_F(CsvReader, AmbiguousHeadersAreRefusedWithTheCandidates) {
  const Error error = refused("x_nm,y_nm,uncertainty [nm],locprecnm\n1,2,3,4\n");
  EXPECT_EQ(error.fault(), Fault::input);
  EXPECT_THAT(error.what(), HasSubstr("'uncertainty [nm]', 'locprecnm'"));
  EXPECT_THAT(refused("x,x,y\n1,2,3\n").what(), HasSubstr("'x', 'x'"));
  EXPECT_THAT(refused("x_nm,y_nm,sigma_x\n1,2,3\n").what(), HasSubstr("only one of x and y"));
  // The same length in nm and in pixels is one quantity twice: nm is taken.
  EXPECT_THAT(read("X (nm),Y (nm),X (pix),Y (pix)\n10,20,1,2\n").position_nm[0], ElementsAre(10, 20, 0));
}

TEST_F(CsvReader, ErrorsNameLineAndField) {
  const std::string head = "x_nm,y_nm,sigma_xy_nm,note\n1,2,3,4\n# c\n";
  EXPECT_THAT(refused(head + "1,2,3\n").what(), HasSubstr("t.csv:4: has 3 fields where the header has 4"));
  EXPECT_THAT(refused(head + "1,2,3,4,5\n").what(), HasSubstr("t.csv:4: has 5 fields"));
  EXPECT_THAT(refused(head + "1,5,2,3,4\n").what(), HasSubstr("decimal written with a comma"));
  for (const char* bad : {"1.2abc", "0x1A", "+1", "1e", "--1", "1.2.3", "one"}) {
    EXPECT_THAT(refused(head + "1," + bad + ",3,4\n").what(),
                HasSubstr("t.csv:4:2: '" + std::string(bad) + "'"));
  }
  EXPECT_THAT(refused(head + "1,\"1,234.5\",3,4\n").what(),
              HasSubstr("t.csv:4:2: '1,234.5' has a separator"));
  EXPECT_THAT(refused(head + "1,,3,4\n").what(), HasSubstr("t.csv:4:2: position is not finite"));
  EXPECT_THAT(refused(head + "nan,2,3,4\n").what(), HasSubstr("t.csv:4:1: position is not finite"));
  EXPECT_THAT(refused(head + "nan(0x1),2,3,4\n").what(), HasSubstr("t.csv:4:1: position is not finite"));
  EXPECT_THAT(refused(head + "1e308,2,3,4\n").what(), HasSubstr("t.csv:4:1: position is out of range"));
  EXPECT_THAT(refused(head + "1e999,2,3,4\n").what(), HasSubstr("t.csv:4:1: position is not finite"));
  EXPECT_THAT(refused(head + "1,2,0,4\n").what(), HasSubstr("t.csv:4:3: uncertainty is not positive"));
  EXPECT_THAT(refused(head + "1,2,-1,4\n").what(), HasSubstr("t.csv:4:3: uncertainty is not positive"));
  EXPECT_THAT(refused(head + "1,2,inf,4\n").what(), HasSubstr("t.csv:4:3: uncertainty is not finite"));
  EXPECT_THAT(refused(head + "1,2,1e-310,4\n").what(), HasSubstr("t.csv:4:3: uncertainty is out of range"));
  // A column that is only kept may be empty or infinite.
  const LocalisationTable table = read(head + "1,2,3,\n");
  EXPECT_TRUE(std::isnan(table.extra[0].values[1]));
}

TEST_F(CsvReader, RowsThatCannotBeUsedAreCountedOnRequest) {
  ReadOptions options;
  options.drop_nonfinite = true;
  const LocalisationTable table =
      read("particle,x_nm,y_nm,sigma_xy_nm\na,nan,2,3\na,1,2,3\nb,1,inf,3\nb,1,2,0\n", options);
  ASSERT_EQ(table.size(), 1u);
  EXPECT_THAT(table.source_row, ElementsAre(2));
  EXPECT_THAT(table.particle_names, ElementsAre("a", "b")) << "a particle without rows still exists";
  ASSERT_EQ(table.rejected.size(), 2u);
  EXPECT_EQ(table.rejected[0].reason, "position is not finite");
  EXPECT_EQ(table.rejected[0].rows, 2u);
  EXPECT_EQ(table.rejected[0].first_row, 1u);
  EXPECT_EQ(table.rejected[1].reason, "uncertainty is not positive");
  EXPECT_EQ(table.rejected[1].first_row, 4u);
}

TEST_F(CsvReader, EveryOtherColumnIsKept) {
  const LocalisationTable table =
      read("x_nm,y_nm,Channel Name,photons,chi [au]\n1,2,red,100,.5\n3,4,blue,200,.6\n5,6,red,300,.7\n");
  ASSERT_EQ(table.extra.size(), 3u);
  EXPECT_THAT(table.extra[0].labels, ElementsAre("red", "blue"));
  EXPECT_THAT(table.extra[0].values, ElementsAre(0, 1, 0));
  EXPECT_THAT(table.extra[1].values, ElementsAre(100, 200, 300));
  EXPECT_EQ(table.extra[2].unit, "au");
}

TEST_F(CsvReader, ParticlesMayBeNumbersOrNames) {
  const LocalisationTable named =
      read("x,y,particle\n1,2,a b\n1,2,10\n1,2,10.0\n1,2,\n1,2,-1\n1,2,-0.5\n1,2,NA\n");
  EXPECT_THAT(named.particle, ElementsAre(0, 1, 2, -1, -1, -1, -1));
  EXPECT_THAT(named.particle_names, ElementsAre("a b", "10", "10.0")) << "ids are text";
  EXPECT_THAT(read("x,y,particle\n1,2,1.000e+00\n1,2,2.000e+01\n").particle_names, ElementsAre("1", "20"))
      << "whole numbers are written as whole numbers";
  EXPECT_THAT(read("x,y,sitenumbers\n1,2,0\n1,2,1\n").particle, ElementsAre(-1, 0))
      << "SMAP: site 0 is no site";
  EXPECT_THAT(read("x,y,particle\n1,2,0\n1,2,1\n").particle, ElementsAre(0, 1));
}

TEST_F(CsvReader, WithoutUncertaintyOneIsAssumedAndSaid) {
  const LocalisationTable table = read("x_nm,y_nm,z_nm\n1,2,3\n1,2,4\n");
  EXPECT_TRUE(table.sigma_assumed && table.axial_sigma_assumed);
  EXPECT_THAT(table.covariance_nm2[0], ElementsAre(100.F, 0.F, 0.F, 100.F, 0.F, 400.F));
  ASSERT_EQ(table.warnings.size(), 1u);
  EXPECT_THAT(table.warnings[0], HasSubstr("no uncertainties"));
}

TEST_F(CsvReader, ConstantZIsPlanar) {
  const LocalisationTable table = read("x_nm,y_nm,z_nm,sigma_xy\n1,2,50,1\n3,4,50,1\n");
  EXPECT_TRUE(table.planar);
  EXPECT_EQ(table.position_nm[0][2], 0);
}

TEST_F(CsvReader, DecimalCommasWhereTheySeparateNothing) {
  for (const char* text :
       {"x_nm;y_nm\n1,5;2\n", "x_nm\ty_nm\n1,5\t2\n", "x_nm,y_nm\n\"1,5\",2\n", "sep=;\nx_nm;y_nm\n1,5;2\n"})
    EXPECT_THAT(read(text).position_nm[0], ElementsAre(1.5, 2, 0)) << text;
  EXPECT_THAT(refused("x_nm;y_nm\n1,5;2.5\n").what(), HasSubstr("with points and with commas"));
}

TEST_F(CsvReader, FieldsInQuotesMayHoldAnything) {
  const LocalisationTable table = read("x_nm,y_nm,particle\n1,2,\"a \"\"b\"\", c\"\n1,2,\" d\"\n");
  EXPECT_THAT(table.particle_names, ElementsAre("a \"b\", c", " d"));
}

TEST_F(CsvReader, RowsWithoutDepthAreJudgedAtTheEnd) {
  std::string flat = "x_nm,y_nm,z_nm,sigma_xy,sigma_z\n", deep = flat, one_off = flat;
  for (int i = 0; i < 200; ++i) {
    flat += "1,2,,1,inf\n";
    deep += "1,2," + std::to_string(i) + ",1,2\n";
    one_off += i == 7 ? "1,2,12,1,2\n" : "1,2,0,1,2\n";
  }
  EXPECT_TRUE(read(flat).planar);
  EXPECT_TRUE(read(one_off).planar);
  EXPECT_FALSE(read(deep).planar);
  EXPECT_THAT(refused(deep + "1,2,,1,2\n" + "1,2,1,1,0\n").what(),
              HasSubstr("t.csv:202:3: position is not finite"));
  ReadOptions drop;
  drop.drop_nonfinite = true;
  const LocalisationTable table = read(deep + "1,2,,1,2\n" + "1,2,1,1,0\n1,2,201,1,2\n", drop);
  EXPECT_EQ(table.size(), 201u);
  EXPECT_EQ(table.source_row.back(), 203u);
  ASSERT_EQ(table.rejected.size(), 2u);
  EXPECT_EQ(table.rejected[1].reason, "uncertainty is not positive");
  EXPECT_EQ(table.rejected[1].first_row, 202u);
  ReadOptions planar;
  planar.planar = true;
  EXPECT_TRUE(read(deep, planar).planar);
}

TEST_F(CsvReader, HopelessFilesFailFast) {
  EXPECT_THAT(refused("").what(), HasSubstr("is empty"));
  EXPECT_EQ(refused("").fault(), Fault::input);
  EXPECT_EQ(refused(std::string("x,y\n1,2\n\0\0\n", 11)).fault(), Fault::input);
  EXPECT_THAT(refused("x,y\n" + std::string(3 << 20, '1')).what(), HasSubstr("longer than 1 MiB"));
  std::string wide;
  for (int i = 0; i < 20000; ++i) wide += "c,";
  ReadOptions csv;
  csv.format = "csv";
  EXPECT_THAT(refused(wide + "x\n", csv).what(), HasSubstr("columns"));
  EXPECT_THAT(refused("\xFF\xFEx,y\n", csv).what(), HasSubstr("UTF-16"));
  EXPECT_THAT(refused(std::string("\xFF\xFEx\0,\0y\0\n\0", 10)).what(), HasSubstr("UTF-16"));
  EXPECT_EQ(test::error_of([&] { read_table("/dev/zero", {}); }).fault(), Fault::input);
  EXPECT_EQ(test::error_of([&] { read_table(folder_.string(), {}); }).fault(), Fault::input);
  EXPECT_EQ(test::error_of([&] { read_table(path("none.csv"), {}); }).fault(), Fault::io);
}

TEST_F(CsvReader, HeaderOnlyIsAnEmptyTable) { EXPECT_EQ(read("x,y\n").size(), 0u); }

TEST_F(CsvReader, NumbersObeyNoLocale) {
  struct Comma : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
  };
  const std::locale before = std::locale::global(std::locale(std::locale(), new Comma));
  const LocalisationTable table = read("x_nm,y_nm,particle\n1234.5,2,1234.5\n1,2,3\n");
  std::locale::global(before);
  EXPECT_EQ(table.position_nm[0][0], 1234.5);
  EXPECT_EQ(table.particle_names[0], "1234.5");
}

TEST_F(CsvReader, BlocksMeetWithoutLosingRows) {
  std::string text = "x_nm,y_nm,particle\n";
  for (int i = 0; i < 40000; ++i) text += std::to_string(i) + ".25,1," + std::to_string(i / 100) + "\n";
  const LocalisationTable table = read(text);
  ASSERT_EQ(table.size(), 40000u);
  EXPECT_EQ(table.position_nm[39999][0], 39999.25);
  EXPECT_EQ(table.source_row.back(), 40000u);
  EXPECT_EQ(table.particle_names.size(), 400u);
}

TEST_F(CsvReader, WrongOptionsAreAUsageError) {
  ReadOptions options;
  options.format = "cvs";
  EXPECT_EQ(refused(plain, options).fault(), Fault::usage);
  options = {};
  options.columns["sigmaxy"] = {"a", "nm", "std"};
  options.columns["x"] = {"", "lightyear", "sd"};
  EXPECT_EQ(violations(options).size(), 4u);
  EXPECT_THAT(violations(ReadOptions{}), IsEmpty());
}

TEST_F(CsvReader, RealTables) {
  SMLM_SHARED_FILE(pores, "smlm/nup107_sim_dol65.csv.gz");
  const LocalisationTable table = read_table(pores, {});
  EXPECT_EQ(table.size(), 8308u);
  EXPECT_EQ(table.particle_names.size(), 200u);
  EXPECT_DOUBLE_EQ(table.position_nm[0][2], 39.5522);
  EXPECT_FLOAT_EQ(table.covariance_nm2[0][0], 2.67664F * 2.67664F);
  SMLM_SHARED_FILE(greek, "formats/smap_locmofit_example_ring_data.csv");
  EXPECT_FLOAT_EQ(read_table(greek, {}).covariance_nm2[0][0], 1.0624113F * 1.0624113F);
  SMLM_SHARED_FILE(lume, "formats/thunderstorm_microtubule_RiesLab.csv");
  EXPECT_EQ(read_table(lume, {}).size(), 2848u);
}

}  // namespace
}  // namespace smlm

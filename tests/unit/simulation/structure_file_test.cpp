#include "polar/simulation/structure_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "smlm/error.hpp"
#include "smlm/h5/file.hpp"
#include "support/temporary_directory.hpp"

namespace polar {
namespace {

using ::testing::HasSubstr;

class StructureFiles : public ::testing::Test {
 protected:
  StructureFile write(const std::string& name, const std::string& text) {
    std::ofstream(directory_.path(name)) << text;
    StructureFile file;
    file.path = directory_.path(name);
    return file;
  }
  void expect_fault(const StructureFile& file, const std::string& part) {
    try {
      read_structure(file);
      ADD_FAILURE() << "accepted: " << file.path;
    } catch (const smlm::Error& e) {
      EXPECT_EQ(e.exit_code(), 3);
      EXPECT_THAT(e.what(), HasSubstr(part));
    }
  }
  support::TemporaryDirectory directory_;
};

TEST_F(StructureFiles, TextIsCentredAndScaled) {
  StructureFile file = write("square.csv", "0,0,5\n2,0,5\n2;2;5\r\n0 2 5");
  const Structure as_is = read_structure(file);
  EXPECT_EQ(as_is.name, "square");
  EXPECT_LT((as_is.site_nm.col(0) - Eigen::Vector3d(-1, -1, 0)).norm(), 1e-12);
  file.radius_nm = 50;
  EXPECT_NEAR(read_structure(file).radius_nm(), 50, 1e-12);
}

TEST_F(StructureFiles, PlyVertices) {
  const std::string header = "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nend_header\n";
  EXPECT_EQ(read_structure(write("a.ply", header + "1 2 3\n4 5 6\n3 0 1 1\n")).site_nm.cols(), 2);
  expect_fault(write("short.ply", header + "1 2 3\n"), "ends before its last vertex");
  expect_fault(write("binary.ply", "ply\nformat binary_little_endian 1.0\nend_header\n"), "format ascii 1.0");
}

TEST_F(StructureFiles, ShapesByNameLabelAndIndex) {
  {
    auto h5 = smlm::h5::File::create(directory_.path("shapes.h5"));
    h5.write("/points", std::vector<std::int16_t>{0, 0, 0, 100, 0, 0, 0, 0, 0, 0, 200, 0, 0, 0, 0, 0, 0, 300},
             {3, 2, 3});
    h5.write_attribute("/points", "scale", 0.5);
    h5.write_strings("/name", {"a", "b", "c"});
    h5.write_strings("/label", {"stick", "stick", "pole"});
    h5.close();
  }
  StructureFile file;
  file.path = directory_.path("shapes.h5");
  EXPECT_NEAR(read_structure(file).radius_nm(), 25, 1e-9);
  file.index = 2;
  EXPECT_NEAR(read_structure(file).radius_nm(), 75, 1e-9);
  file.index = 1;
  file.label = "stick";
  EXPECT_EQ(read_structure(file).name, "b");
  file.index = 0;
  file.label = "c";
  EXPECT_EQ(read_structure(file).name, "c");
  file.label = "d";
  expect_fault(file, "no shape 'd'");
  file.label.clear();
  file.index = 3;
  expect_fault(file, "it holds 3 shapes");
}

TEST_F(StructureFiles, ShapesWithNamesOrScalesAmissAreToldFromWholeOnes) {
  StructureFile file;
  file.path = directory_.path("shapes.h5");
  const auto write_shapes = [&](double scale) {
    auto h5 = smlm::h5::File::create(file.path);
    h5.write("/points", std::vector<double>{0, 0, 0, 1, 1, 1, 0, 0, 0, 2, 2, 2}, {2, 2, 3});
    h5.write_attribute("/points", "scale", scale);
    h5.write_strings("/name", {"only one"});
    h5.close();
  };
  write_shapes(1);
  file.index = 1;
  EXPECT_EQ(read_structure(file).name, "1");
  write_shapes(-1);
  expect_fault(file, "shapes.h5:points@scale: expected one positive number");
}

TEST_F(StructureFiles, FaultsNameTheFile) {
  expect_fault(write("empty.csv", ""), "holds no points");
  expect_fault(write("two.csv", "1,2,3\n1,2\n"), "two.csv:2");
  expect_fault(write("huge.csv", "inf,0,0\n1,2,3\n"), "finite");
  StructureFile none;
  none.path = directory_.path("none.csv");
  expect_fault(none, "no such file");
}

TEST_F(StructureFiles, DevelopmentShapes) {
  StructureFile file;
  file.path = POLAR_SHARED_DATA "/shapes/princeton_shape_benchmark_dev.h5";
  if (!std::filesystem::exists(file.path)) GTEST_SKIP() << "development shapes are not here";
  file.radius_nm = 80;
  const Structure s = read_structure(file);
  EXPECT_EQ(s.site_nm.cols(), 2048);
  EXPECT_NEAR(s.radius_nm(), 80, 1e-9);
}

}  // namespace
}  // namespace polar

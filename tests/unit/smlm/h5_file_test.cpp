#include <fcntl.h>
#include <gmock/gmock.h>
#include <hdf5.h>
#include <sys/file.h>

#include <limits>

#include "fixture.hpp"
#include "smlm/h5/file.hpp"

namespace smlm::h5 {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using H5FileTest = test::TemporaryFolder;

TEST_F(H5FileTest, ArraysComeBackWithShapeAndAreConverted) {
  {
    File file = File::create(path("a.h5"));
    file.write<float>("/group/deep/values", {1.5F, 2, 3, 4, 5, 6}, {2, 3});
    file.write<std::int64_t>("/zipped", std::vector<std::int64_t>(100000, 7), {}, {4, {}});
    file.write<double>("/none", {});
    file.close();
  }
  const File file = File::open(path("a.h5"));
  EXPECT_THAT(file.info("/group/deep/values").shape, ElementsAre(2, 3));
  EXPECT_EQ(file.info("/group/deep/values").kind, Kind::real);
  EXPECT_THAT(file.read<double>("/group/deep/values"), ElementsAre(1.5, 2, 3, 4, 5, 6));
  const auto zipped = file.read<std::int32_t>("/zipped");
  ASSERT_EQ(zipped.size(), 100000u);
  EXPECT_EQ(zipped.back(), 7);
  EXPECT_TRUE(file.read<double>("/none").empty());
  EXPECT_FALSE(file.exists("/nothing/here"));
  EXPECT_LT(std::filesystem::file_size(path("a.h5")), 50000u);
}

TEST_F(H5FileTest, TablesAreReadByFieldName) {
  {
    File file = File::create(path("t.h5"));
    std::vector<std::uint32_t> frame(40000);
    std::vector<float> x(40000);
    for (std::size_t i = 0; i < frame.size(); ++i) {
      frame[i] = static_cast<std::uint32_t>(i);
      x[i] = static_cast<float>(i) / 2;
    }
    file.write_table("/locs", {table_column("frame", frame), table_column("x", x)});
    file.close();
  }
  const File file = File::open(path("t.h5"));
  const DatasetInfo info = file.info("/locs");
  ASSERT_EQ(info.kind, Kind::compound);
  ASSERT_EQ(info.members.size(), 2u);
  EXPECT_EQ(info.members[0].name, "frame");
  EXPECT_THAT(file.read_member<double>("/locs", "x", 39998, 2), ElementsAre(19999.0, 19999.5));
  EXPECT_EQ(file.read_member<std::int64_t>("/locs", "frame", 20000, 1).front(), 20000);
  EXPECT_THAT(test::error_of([&] { file.read_member<double>("/locs", "y", 0, 1); }).what(), HasSubstr("'y'"));
  EXPECT_EQ(test::error_of([&] { file.read_member<double>("/locs", "x", 39999, 2); }).fault(), Fault::input);
}

// Found by fuzzing: HDF5 1.10 believes such types, and converting from them writes past its buffers.
TEST_F(H5FileTest, FieldsOfImpossibleTypesAreRefused) {
  // What follows a field's name: its offset in the record at 0, then of its type the size at 36, the
  // precision in bits at 42, and of a real the widths of exponent and mantissa at 45 and 47.
  const auto with_byte = [&](std::size_t position, char was, char value) {
    File file = File::create(path("t.h5"));
    file.write_table("/locs", {table_column("first", std::vector<float>{1, 2}),
                               table_column("second", std::vector<float>{3, 4})});
    file.close();
    std::ifstream in(path("t.h5"), std::ios::binary);
    std::string bytes{std::istreambuf_iterator<char>(in), {}};
    const std::string name("second\0\0", 8);
    char& byte = bytes.at(bytes.find(name) + name.size() + position);
    EXPECT_EQ(byte, was) << position;
    byte = value;
    write("t.h5", bytes);
    return File::open(path("t.h5")).read_member<double>("/locs", "second", 0, 2);
  };
  EXPECT_THAT(with_byte(0, 4, 4), ElementsAre(3, 4));
  for (const char offset : {'\0', '\3', '\5', '\100'})
    EXPECT_THAT(test::error_of([&] { with_byte(0, 4, offset); }).what(), HasSubstr("damaged"));
  EXPECT_THAT(test::error_of([&] { with_byte(36, 4, 'd'); }).what(), HasSubstr("damaged"));
  EXPECT_THAT(test::error_of([&] { with_byte(42, 32, 94); }).what(), HasSubstr("of a damaged type"));
  EXPECT_THAT(test::error_of([&] { with_byte(45, 8, 90); }).what(), HasSubstr("of a damaged type"));
  EXPECT_THAT(test::error_of([&] { with_byte(47, 23, 90); }).what(), HasSubstr("of a damaged type"));
}

// Found by fuzzing: HDF5 1.10 reads as many bytes as the shape wants, whatever is there.
TEST_F(H5FileTest, ACompactDataSetThatIsSmallerThanItsShapeIsRefused) {
  const std::string extent("\x4d\0\0\0\0\0\0\0", 8);  // 77, in the object's header
  {
    const hid_t file = H5Fcreate(path("t.h5").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    const hsize_t length = 77;
    const hid_t space = H5Screate_simple(1, &length, nullptr), layout = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_layout(layout, H5D_COMPACT);
    const hid_t data = H5Dcreate2(file, "few", H5T_NATIVE_UINT8, space, H5P_DEFAULT, layout, H5P_DEFAULT);
    const std::vector<std::uint8_t> ones(length, 255);
    H5Dwrite(data, H5T_NATIVE_UINT8, H5S_ALL, H5S_ALL, H5P_DEFAULT, ones.data());
    H5Dclose(data), H5Pclose(layout), H5Sclose(space), H5Fclose(file);
  }
  EXPECT_EQ(File::open(path("t.h5")).read<int>("/few").size(), 77u);
  std::ifstream in(path("t.h5"), std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(in), {}};
  ASSERT_NE(bytes.find(extent), std::string::npos);
  for (std::size_t at; (at = bytes.find(extent)) != std::string::npos;) bytes[at] = 99;
  write("t.h5", bytes);
  EXPECT_THAT(test::error_of([&] { File::open(path("t.h5")).read<int>("/few"); }).what(),
              HasSubstr("claims more bytes than it stores"));
}

// Found by fuzzing: HDF5 1.10 makes chunks in memory of the size that the layout states, and fills of each as
// much as its index states.
TEST_F(H5FileTest, ChunksOfOtherSizesThanTheirElementsNeedAreRefused) {
  const auto with_byte = [&](const std::string& where, std::size_t position, char value) {
    const hid_t file = H5Fcreate(path("t.h5").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    const hsize_t length = 100, chunk = 77;
    const hid_t space = H5Screate_simple(1, &length, nullptr), layout = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_chunk(layout, 1, &chunk);
    const hid_t data = H5Dcreate2(file, "few", H5T_NATIVE_INT, space, H5P_DEFAULT, layout, H5P_DEFAULT);
    const std::vector<int> values(length, -1);
    H5Dwrite(data, H5T_NATIVE_INT, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    H5Dclose(data), H5Pclose(layout), H5Sclose(space), H5Fclose(file);
    std::ifstream in(path("t.h5"), std::ios::binary);
    std::string bytes{std::istreambuf_iterator<char>(in), {}};
    bytes.at(bytes.find(where) + position) = value;
    write("t.h5", bytes);
    return File::open(path("t.h5")).read<int>("/few");
  };
  const std::string layout("\x4d\0\0\0\4\0\0\0", 8);  // 77 elements of 4 bytes
  const std::string index("\x34\1\0\0\0\0\0\0", 8);   // a chunk of 308 bytes, no filter left out
  EXPECT_THAT(with_byte(layout, 4, 4), Each(-1));
  EXPECT_THAT(test::error_of([&] { with_byte(layout, 4, 1); }).what(),
              HasSubstr("has elements of another size"));
  EXPECT_THAT(with_byte(index, 0, 0x34), Each(-1));
  EXPECT_THAT(test::error_of([&] { with_byte(index, 0, 0x21); }).what(),
              HasSubstr("smaller than they claim"));
}

// ParaView 5.11 refuses VTKHDF files whose Type is of variable length, UTF-8 or one byte longer.
TEST_F(H5FileTest, StringAttributesAreFixedAsciiWithoutATerminator) {
  {
    File file = File::create(path("s.h5"));
    file.make_group("/VTKHDF");
    file.write_string_attribute("/VTKHDF", "Type", "ImageData");
    file.write_attribute<std::int64_t>("/VTKHDF", "Version", std::vector<std::int64_t>{1, 0});
    file.write_attribute("/VTKHDF", "scale", 0.5);
    file.close();
  }
  {
    const File file = File::open(path("s.h5"));
    EXPECT_EQ(file.read_string_attribute("/VTKHDF", "Type"), "ImageData");
    EXPECT_THAT(file.read_attribute<int>("/VTKHDF", "Version"), ElementsAre(1, 0));
    EXPECT_THAT(file.read_attribute<double>("/VTKHDF", "scale"), ElementsAre(0.5));
    EXPECT_FALSE(file.has_attribute("/VTKHDF", "none"));
  }
  const hid_t raw = H5Fopen(path("s.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const hid_t attribute = H5Aopen_by_name(raw, "/VTKHDF", "Type", H5P_DEFAULT, H5P_DEFAULT);
  const hid_t type = H5Aget_type(attribute);
  const hid_t space = H5Aget_space(attribute);
  EXPECT_EQ(H5Tget_size(type), 9u);
  EXPECT_EQ(H5Tget_strpad(type), H5T_STR_NULLPAD);
  EXPECT_EQ(H5Tget_cset(type), H5T_CSET_ASCII);
  EXPECT_EQ(H5Sget_simple_extent_type(space), H5S_SCALAR);
  H5Sclose(space);
  H5Tclose(type);
  H5Aclose(attribute);
  H5Fclose(raw);
}

TEST_F(H5FileTest, StringsRoundTrip) {
  {
    File file = File::create(path("s.h5"));
    file.write_strings("/names", {"a", "", "\xCF\x83x"});
    file.close();
  }
  EXPECT_THAT(File::open(path("s.h5")).read_strings("/names"), ElementsAre("a", "", "\xCF\x83x"));
}

TEST_F(H5FileTest, StringsOfVariableLengthAreReadUnlessTheCallerWritesNone) {
  const hid_t raw = H5Fcreate(path("v.h5").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, H5T_VARIABLE);
  const hsize_t two = 2;
  const hid_t space = H5Screate_simple(1, &two, nullptr);
  const hid_t data = H5Dcreate2(raw, "names", type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  const char* const values[] = {"short", "not so short"};
  H5Dwrite(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
  H5Dclose(data), H5Sclose(space), H5Tclose(type), H5Fclose(raw);
  EXPECT_THAT(File::open(path("v.h5")).read_strings("/names"), ElementsAre("short", "not so short"));
  Limits fixed_only;
  fixed_only.variable_text = false;
  EXPECT_THAT(test::error_of([&] { File::open(path("v.h5"), fixed_only).read_strings("/names"); }).what(),
              HasSubstr("v.h5:/names: holds text of variable length"));
}

TEST_F(H5FileTest, LinksToOtherFilesAreNeverFollowed) {
  {
    File other = File::create(path("other.h5"));
    other.write<double>("/x", {1, 2, 3});
    other.close();
    const hid_t raw = H5Fcreate(path("links.h5").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    H5Lcreate_external(path("other.h5").c_str(), "/x", raw, "external", H5P_DEFAULT, H5P_DEFAULT);
    H5Lcreate_soft("/loop", raw, "loop", H5P_DEFAULT, H5P_DEFAULT);
    H5Fclose(raw);
  }
  const File file = File::open(path("links.h5"));
  EXPECT_THAT(test::error_of([&] { file.read<double>("/external"); }).what(), HasSubstr("link"));
  EXPECT_THAT(test::error_of([&] { file.read<double>("/loop"); }).what(), HasSubstr("link"));
  EXPECT_TRUE(file.list("/").empty());
}

TEST_F(H5FileTest, ExternalStorageAndVirtualDataSetsAreRefused) {
  write("raw.bin", std::string(24, '\0'));
  {
    const hid_t raw = H5Fcreate(path("e.h5").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    const hsize_t extent = 3;
    const hid_t space = H5Screate_simple(1, &extent, nullptr);
    const hid_t external = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_external(external, path("raw.bin").c_str(), 0, 24);
    H5Dclose(H5Dcreate2(raw, "external", H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, external, H5P_DEFAULT));
    const hid_t virtual_set = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_virtual(virtual_set, space, path("other.h5").c_str(), "/x", space);
    H5Dclose(H5Dcreate2(raw, "virtual", H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, virtual_set, H5P_DEFAULT));
    H5Pclose(external);
    H5Pclose(virtual_set);
    H5Sclose(space);
    H5Fclose(raw);
  }
  const File file = File::open(path("e.h5"));
  EXPECT_THAT(test::error_of([&] { file.read<double>("/external"); }).what(), HasSubstr("another file"));
  EXPECT_THAT(test::error_of([&] { file.read<double>("/virtual"); }).what(), HasSubstr("virtual"));
}

TEST_F(H5FileTest, SizesAreCheckedBeforeMemoryIsTaken) {
  {
    const hid_t raw = H5Fcreate(path("bomb.h5").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    const hsize_t extent = hsize_t{1} << 40;
    const hsize_t chunk = 1 << 20;
    const hid_t space = H5Screate_simple(1, &extent, nullptr);
    const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_chunk(properties, 1, &chunk);
    H5Pset_deflate(properties, 9);
    H5Dclose(H5Dcreate2(raw, "x", H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, properties, H5P_DEFAULT));
    H5Pclose(properties);
    H5Sclose(space);
    H5Fclose(raw);
  }
  EXPECT_THAT(test::error_of([&] { File::open(path("bomb.h5")).read<double>("/x"); }).what(),
              HasSubstr("almost none"));
  {
    File file = File::create(path("big.h5"));
    file.write<double>("/x", std::vector<double>(1000, 1.0));
    file.close();
  }
  Limits small;
  small.max_array_bytes = 4000;
  EXPECT_EQ(test::error_of([&] { File::open(path("big.h5"), small).read<double>("/x"); }).fault(),
            Fault::resource);
}

TEST_F(H5FileTest, ATruncatedFileIsAnInputErrorWhereverItEnds) {
  {
    File file = File::create(path("whole.h5"));
    std::vector<double> values(30000);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<double>(i * i % 1013);
    file.write<double>("/plain", values);
    file.write<double>("/zipped", values, {}, {5, {}});
    file.close();
  }
  std::ifstream source(path("whole.h5"), std::ios::binary);
  const std::string whole{std::istreambuf_iterator<char>(source), {}};
  for (std::size_t bytes = 0; bytes < whole.size(); bytes += 4096) {
    const std::string cut = write("cut.h5", whole.substr(0, bytes));
    const Error error = test::error_of([&] {
      const File file = File::open(cut);
      file.read<double>("/plain");
      file.read<double>("/zipped");
    });
    EXPECT_EQ(error.fault(), Fault::input) << bytes << " bytes: " << error.what();
  }
}

TEST_F(H5FileTest, WhatIsNotAFileOrNotHdf5IsRefused) {
  EXPECT_EQ(test::error_of([&] { File::open(path("none.h5")); }).fault(), Fault::io);
  EXPECT_EQ(test::error_of([&] { File::open(folder_.string()); }).fault(), Fault::input);
  EXPECT_EQ(test::error_of([&] { File::open(write("text.h5", "x,y\n1,2\n")); }).fault(), Fault::input);
  EXPECT_FALSE(File::is_hdf5(path("text.h5")));
}

TEST_F(H5FileTest, ALockIsNamed) {
  {
    File file = File::create(path("l.h5"));
    file.close();
  }
  const int fd = ::open(path("l.h5").c_str(), O_RDWR);
  ASSERT_EQ(::flock(fd, LOCK_EX | LOCK_NB), 0);
  const Error error = test::error_of([&] { File::open(path("l.h5")); });
  EXPECT_EQ(error.fault(), Fault::io);
  EXPECT_THAT(error.what(), HasSubstr("lock"));
  ::close(fd);
}

TEST_F(H5FileTest, AFileThatCannotBeCreatedIsAnIoError) {
  const Error error = test::error_of([&] {
    File file = File::create(path("no/such/folder.h5"));
    file.close();
  });
  EXPECT_EQ(error.fault(), Fault::io);
}

TEST_F(H5FileTest, ShapesThatDoNotFitAreRefused) {
  File file = File::create(path("a.h5"));
  EXPECT_EQ(test::error_of([&] { file.write<double>("/x", {1, 2, 3}, {2, 2}); }).fault(), Fault::usage);
  EXPECT_EQ(test::error_of([&] {
              const std::vector<int> two{1, 2};
              const std::vector<int> three{1, 2, 3};
              file.write_table("/t", {table_column("a", two), table_column("b", three)});
            }).fault(),
            Fault::usage);
}

}  // namespace
}  // namespace smlm::h5

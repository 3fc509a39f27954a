// Formats that are not text: SMAP, DECODE, pandas, .mat, .npy, .smlm.
#include <gmock/gmock.h>
#include <hdf5.h>
#include <matio.h>
#include <zip.h>

#include <cmath>
#include <cstring>

#include "fixture.hpp"
#include "smlm/h5/file.hpp"
#include "smlm/table_reader.hpp"

namespace smlm {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

class VendorBinary : public test::TemporaryFolder {};

TEST_F(VendorBinary, SmapMat) {
  {
    h5::File file = h5::File::create(path("a_sml.mat"));
    file.write<float>("/saveloc/loc/xnm", {10, 20, 30}, {1, 3});
    file.write<double>("/saveloc/loc/ynm", {1, 2, 3}, {1, 3});
    file.write<float>("/saveloc/loc/locprecnm", {4, 4, 4}, {1, 3});
    file.write<double>("/saveloc/loc/sitenumbers", {0, 5, 5}, {1, 3});
    file.write<double>("/saveloc/loc/setting", {1}, {1, 1});
    file.close();
  }
  const LocalisationTable table = read_table(path("a_sml.mat"), {});
  EXPECT_THAT(table.formats, ElementsAre("smap"));
  EXPECT_THAT(table.position_nm[2], ElementsAre(30, 3, 0));
  EXPECT_THAT(table.particle, ElementsAre(-1, 0, 0));
  EXPECT_FLOAT_EQ(table.covariance_nm2[0][0], 16);
  SMLM_SHARED_FILE(real, "formats/locan_smap_dstorm_data.mat");
  const LocalisationTable dstorm = read_table(real, {});
  EXPECT_EQ(dstorm.size(), 4884u);
  EXPECT_NEAR(dstorm.position_nm[0][0], 1459.3857, 1e-3);
  EXPECT_NEAR(std::sqrt(dstorm.covariance_nm2[0][3]), 48.649525, 1e-4);
  EXPECT_NEAR(std::sqrt(dstorm.covariance_nm2[0][5]), 107.57328, 1e-3);
}

TEST_F(VendorBinary, DecodeH5) {
  SMLM_SHARED_FILE(real, "formats/locan_decode_dstorm_data.h5");
  const LocalisationTable table = read_table(real, {});
  EXPECT_THAT(table.formats, ElementsAre("decode"));
  EXPECT_EQ(table.size(), 96u);
  const h5::File raw = h5::File::open(real);
  const auto xyz = raw.read<double>("/data/xyz");
  const auto sigma = raw.read<double>("/data/xyz_sig");
  EXPECT_DOUBLE_EQ(table.position_nm[5][0], xyz[15] * 127);
  EXPECT_DOUBLE_EQ(table.position_nm[5][1], xyz[16] * 117);
  EXPECT_DOUBLE_EQ(table.position_nm[5][2], xyz[17]);
  EXPECT_NEAR(std::sqrt(table.covariance_nm2[5][3]), sigma[16] * 117, 1e-3);
  SMLM_SHARED_FILE(empty, "formats/locan_decode_dstorm_data_empty.h5");
  EXPECT_EQ(read_table(empty, {}).size(), 0u);
}

TEST_F(VendorBinary, PicassoWrittenByPandas) {
  {
    h5::File file = h5::File::create(path("p.hdf5"));
    file.write_strings("/locs/axis0", {"x", "y", "lpx", "lpy", "group"});
    file.write_strings("/locs/block0_items", {"x", "y", "lpx", "lpy"});
    file.write<float>("/locs/block0_values", {1, 2, .1F, .2F, 3, 4, .1F, .2F}, {2, 4});
    file.write_strings("/locs/block1_items", {"group"});
    file.write<std::int32_t>("/locs/block1_values", {4, 9}, {2, 1});
    file.close();
  }
  ReadOptions options;
  options.pixel_size_nm = 100;
  const LocalisationTable table = read_table(path("p.hdf5"), options);
  EXPECT_THAT(table.formats, ElementsAre("picasso_pandas"));
  EXPECT_THAT(table.position_nm[1], ElementsAre(300, 400, 0));
  EXPECT_NEAR(table.covariance_nm2[1][3], 400, 1e-3);
  EXPECT_THAT(table.particle_names, ElementsAre("4", "9"));
}

// What to_hdf(..., format="table") writes: array fields, whose names stand in attributes as pickled lists.
TEST_F(VendorBinary, PicassoWrittenByPandasAsATable) {
  struct Row {
    std::int64_t index;
    float block0[4];
    std::int64_t block1[2];
  };
  const Row rows[]{{0, {1, 2, .1F, .2F}, {7, 9912140633506421}},
                   {1, {3, 4, .1F, .2F}, {8, 9912140633506422}}};
  const hsize_t four = 4, two = 2;
  const hid_t floats = H5Tarray_create2(H5T_NATIVE_FLOAT, 1, &four);
  const hid_t whole = H5Tarray_create2(H5T_NATIVE_INT64, 1, &two);
  const hid_t type = H5Tcreate(H5T_COMPOUND, sizeof(Row));
  H5Tinsert(type, "index", offsetof(Row, index), H5T_NATIVE_INT64);
  H5Tinsert(type, "values_block_0", offsetof(Row, block0), floats);
  H5Tinsert(type, "values_block_1", offsetof(Row, block1), whole);
  const hid_t file = H5Fcreate(path("t.hdf5").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  const hid_t group = H5Gcreate2(file, "/locs", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  const hid_t space = H5Screate_simple(1, &two, nullptr);
  const hid_t data = H5Dcreate2(group, "table", type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  H5Dwrite(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, rows);
  for (const auto& [name, text] :
       {std::pair<const char*, std::string>{"values_block_0_kind",
                                            "(lp0\nVx\np1\naVy\np2\naVlpx\np3\naVlpy\np4\na."},
        {"values_block_1_kind", "(lp1\nVframe\np2\naVgroup\np3\na."}}) {
    const hid_t word = H5Tcopy(H5T_C_S1);
    H5Tset_size(word, text.size());
    const hid_t scalar = H5Screate(H5S_SCALAR);
    const hid_t attribute = H5Acreate2(data, name, word, scalar, H5P_DEFAULT, H5P_DEFAULT);
    H5Awrite(attribute, word, text.data());
    H5Aclose(attribute);
    H5Sclose(scalar);
    H5Tclose(word);
  }
  for (const hid_t t : {floats, whole, type}) H5Tclose(t);
  H5Sclose(space);
  H5Dclose(data);
  H5Gclose(group);
  H5Fclose(file);
  ReadOptions options;
  options.pixel_size_nm = 100;
  const LocalisationTable table = read_table(path("t.hdf5"), options);
  EXPECT_THAT(table.formats, ElementsAre("picasso_pandas"));
  EXPECT_THAT(table.position_nm[1], ElementsAre(300, 400, 0));
  EXPECT_THAT(table.particle_names, ElementsAre("9912140633506421", "9912140633506422"));
  ASSERT_EQ(table.extra.size(), 1u);
  EXPECT_THAT(table.extra[0].values, ElementsAre(7, 8));
}

// A MATLAB 5 file with one cell per particle: points (2 x 3) and sigma (2 x 2).
void write_particles_v5(const std::string& path, const char* variable, const char* points_name) {
  mat_t* file = Mat_CreateVer(path.c_str(), nullptr, MAT_FT_MAT5);
  std::size_t cell_dims[2]{1, 2};
  matvar_t* cells = Mat_VarCreate(variable, MAT_C_CELL, MAT_T_CELL, 2, cell_dims, nullptr, 0);
  for (int i = 0; i < 2; ++i) {
    const char* fields[]{points_name, "sigma"};
    std::size_t one[2]{1, 1};
    matvar_t* particle = Mat_VarCreateStruct(nullptr, 2, one, fields, 2);
    double points[6]{1. + i, 2, 3, 4, 5, 6};  // column-major: x 1 2, y 3 4, z 5 6
    double sigma[4]{.5, .5, 2, 2};
    std::size_t points_dims[2]{2, 3};
    std::size_t sigma_dims[2]{2, 2};
    Mat_VarSetStructFieldByName(
        particle, points_name, 0,
        Mat_VarCreate(nullptr, MAT_C_DOUBLE, MAT_T_DOUBLE, 2, points_dims, points, 0));
    Mat_VarSetStructFieldByName(particle, "sigma", 0,
                                Mat_VarCreate(nullptr, MAT_C_DOUBLE, MAT_T_DOUBLE, 2, sigma_dims, sigma, 0));
    Mat_VarSetCell(cells, i, particle);
  }
  Mat_VarWrite(file, cells, MAT_COMPRESSION_ZLIB);
  Mat_VarFree(cells);
  Mat_Close(file);
}

TEST_F(VendorBinary, ParticleCellsAskWhatTheyCannotTell) {
  write_particles_v5(path("p.mat"), "Particles", "points");
  const LocalisationTable table = read_table(path("p.mat"), {});
  EXPECT_THAT(table.formats, ElementsAre("particle_cells"));
  ASSERT_EQ(table.size(), 4u);
  EXPECT_THAT(table.position_nm[2], ElementsAre(2, 3, 5));
  EXPECT_THAT(table.particle_names, ElementsAre("1", "2"));
  EXPECT_FLOAT_EQ(table.covariance_nm2[0][5], 4);
  EXPECT_THAT(table.warnings, Contains(HasSubstr("input.sigma_kind")));
  EXPECT_THAT(table.warnings, Contains(HasSubstr("input.unit")));

  ReadOptions options;
  options.unit = "px";
  options.pixel_size_nm = 100;
  options.sigma_kind = "variance";
  const LocalisationTable said = read_table(path("p.mat"), options);
  EXPECT_THAT(said.position_nm[2], ElementsAre(200, 300, 500));
  EXPECT_FLOAT_EQ(said.covariance_nm2[0][0], .5F * 100 * 100);
  EXPECT_THAT(said.warnings, Not(Contains(HasSubstr("sigma_kind"))));
}

TEST_F(VendorBinary, OtherMatFilesAreRefused) {
  write_particles_v5(path("o.mat"), "others", "points");
  EXPECT_THAT(test::error_of([&] { read_table(path("o.mat"), {}); }).what(),
              HasSubstr("MATLAB file without a known table"));
  write_particles_v5(path("w.mat"), "particles", "pints");
  EXPECT_THAT(test::error_of([&] { read_table(path("w.mat"), {}); }).what(), HasSubstr("holds no particle"));
}

TEST_F(VendorBinary, RealParticleCellsEqualTheirCsv) {
  SMLM_SHARED_FILE(mat, "smlm/nup107_sim_dol65.mat");
  SMLM_SHARED_FILE(csv, "smlm/nup107_sim_dol65.csv.gz");
  const LocalisationTable a = read_table(mat, {});
  const LocalisationTable b = read_table(csv, {});
  ASSERT_EQ(a.size(), b.size());
  EXPECT_EQ(a.particle, b.particle);
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      ASSERT_NEAR(a.position_nm[i][axis], b.position_nm[i][axis], 1e-3);
    ASSERT_NEAR(std::sqrt(a.covariance_nm2[i][5]), std::sqrt(b.covariance_nm2[i][5]), 1e-2);
  }
  SMLM_SHARED_FILE(logo, "smlm/tud_logo_dol50_real_2d.mat");
  const LocalisationTable flat = read_table(logo, {});
  EXPECT_EQ(flat.size(), 278378u);
  EXPECT_EQ(flat.particle_names.size(), 441u);
  EXPECT_TRUE(flat.planar);
  EXPECT_THAT(flat.warnings, Contains(HasSubstr("another unit"))) << "these are camera pixels";
}

// An .npy file of the classic MINFLUX layout: two iterations, the second one final.
std::string minflux_npy(std::size_t records, bool flat = false) {
  std::string header = std::string("{'descr': [('itr', [('itr', '<i4'), ('loc', '<f8', (") +
                       (flat ? "2" : "3") +
                       ",)), ('efo', '<f4')], (2,)), ('tid', '<i4'), "
                       "('vld', '|b1'), "
                       "('nr', '>u2')], 'fortran_order': False, 'shape': (" +
                       std::to_string(records) + ",), }";
  header.resize((header.size() + 10 + 63) / 64 * 64 - 10, ' ');
  std::string file("\x93NUMPY\x01\x00", 8);
  file += static_cast<char>(header.size() & 255);
  file += static_cast<char>(header.size() >> 8);
  file += header;
  const auto put = [&file](const auto& value) {
    file.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  for (std::size_t i = 0; i < records; ++i) {
    for (int iteration = 0; iteration < 2; ++iteration) {
      put(std::int32_t{iteration});
      // Nanometres 100 + i, 200 + 2 i, 50 + i in the final iteration, rubbish before.
      const double scale = iteration == 1 ? 1e-9 : 7;
      put(scale * (100 + static_cast<double>(i % 5)));
      put(scale * (200 + 2 * static_cast<double>(i % 5)));
      if (!flat) put(scale * (50 + static_cast<double>(i % 5)));
      put(static_cast<float>(1000 * iteration));
    }
    put(static_cast<std::int32_t>(i / 5));
    put(static_cast<char>(i != 3));
    file += '\x01';
    file += static_cast<char>(i);
  }
  return file;
}

TEST_F(VendorBinary, MinfluxTakesTheLastIterationInMetres) {
  const LocalisationTable table = read_table(write("m.npy", minflux_npy(10)), {});
  EXPECT_THAT(table.formats, ElementsAre("minflux"));
  EXPECT_THAT(table.warnings, Contains(HasSubstr("z is multiplied by 0.7")));
  ASSERT_EQ(table.size(), 9u);
  EXPECT_NEAR(table.position_nm[1][0], 101, 1e-9);
  EXPECT_NEAR(table.position_nm[1][2], 0.7 * 51, 1e-9);
  EXPECT_THAT(table.source_row, ElementsAre(1, 2, 3, 5, 6, 7, 8, 9, 10));
  ASSERT_EQ(table.rejected.size(), 1u);
  EXPECT_EQ(table.rejected[0].first_row, 4u);
  // The second trace has 0, 1, 2, 3, 4 nm: its standard deviation is sqrt(2.5); the first has lost a row, so
  // it is too short and takes the median.
  EXPECT_NEAR(table.covariance_nm2[8][0], 2.5, 1e-5);
  EXPECT_NEAR(table.covariance_nm2[8][3], 10, 1e-5);
  EXPECT_NEAR(table.covariance_nm2[8][5], 2.5 * .49, 1e-5);
  EXPECT_NEAR(table.covariance_nm2[0][0], 2.5, 1e-5);
  const auto extra = [&](const std::string& name) {
    for (const ExtraColumn& column : table.extra) {
      if (column.name == name) return column.values;
    }
    return std::vector<double>{};
  };
  EXPECT_EQ(extra("efo").at(0), 1000) << "of the final iteration";
  EXPECT_EQ(extra("nr").at(1), 257) << "big endian";
  ReadOptions options;
  options.minflux_z_factor = 1;
  EXPECT_NEAR(read_table(path("m.npy"), options).position_nm[0][2], 50, 1e-9);
}

TEST_F(VendorBinary, DamagedNpyFilesAreRefused) {
  const std::string whole = minflux_npy(10);
  const auto refused = [&](const std::string& bytes) {
    return test::error_of([&] { read_table(write("d.npy", bytes), {}); });
  };
  for (std::size_t bytes = 6; bytes < whole.size(); bytes += 37) {
    EXPECT_EQ(refused(whole.substr(0, bytes)).fault(), Fault::input) << bytes;
  }
  std::string objects = whole;
  objects.replace(objects.find("'<i4'"), 5, "'|O8'");
  EXPECT_THAT(refused(objects).what(), HasSubstr("Python objects"));
  std::string plain("\x93NUMPY\x01\x00\x3a\x00{'descr': '<f8', 'fortran_order': False, 'shape': (1,), }\n",
                    68);
  EXPECT_THAT(refused(plain + std::string(8, '\0')).what(), HasSubstr("not a MINFLUX table"));
}

TEST_F(VendorBinary, MinfluxInThePlaneHasTwoNumbers) {
  const LocalisationTable table = read_table(write("flat.npy", minflux_npy(10, true)), {});
  EXPECT_TRUE(table.planar);
  EXPECT_EQ(table.size(), 9u);
  EXPECT_NEAR(table.position_nm[1][1], 202, 1e-9);
}

TEST_F(VendorBinary, RealMinfluxZipsAreNamed) {
  SMLM_SHARED_FILE(zipped, "formats/pyminflux_aggregates.npy.zip");
  EXPECT_THAT(test::error_of([&] { read_table(zipped, {}); }).what(), HasSubstr("unpack it first"));
}

TEST_F(VendorBinary, MinfluxMat) {
  mat_t* file = Mat_CreateVer(path("m.mat").c_str(), nullptr, MAT_FT_MAT5);
  constexpr std::size_t n = 6;
  double loc[n * 2 * 3];
  double efo[n * 2];
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < 2; ++k) {
      efo[k * n + i] = static_cast<double>(k);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        loc[axis * n * 2 + k * n + i] = k == 1 ? 1e-9 * static_cast<double>(i + 10 * axis) : 5;
      }
    }
  }
  std::size_t one[2]{1, 1}, cube[3]{n, 2, 3}, flat[2]{n, 2}, row[2]{1, n};
  const char* fields[]{"loc", "efo"};
  matvar_t* itr = Mat_VarCreateStruct("itr", 2, one, fields, 2);
  Mat_VarSetStructFieldByName(itr, "loc", 0,
                              Mat_VarCreate(nullptr, MAT_C_DOUBLE, MAT_T_DOUBLE, 3, cube, loc, 0));
  Mat_VarSetStructFieldByName(itr, "efo", 0,
                              Mat_VarCreate(nullptr, MAT_C_DOUBLE, MAT_T_DOUBLE, 2, flat, efo, 0));
  std::int32_t tid[n]{1, 1, 1, 1, 1, 1};
  std::uint8_t vld[n]{1, 1, 1, 1, 1, 0};
  matvar_t* trace = Mat_VarCreate("tid", MAT_C_INT32, MAT_T_INT32, 2, row, tid, 0);
  matvar_t* valid = Mat_VarCreate("vld", MAT_C_UINT8, MAT_T_UINT8, 2, row, vld, 0);
  for (matvar_t* variable : {itr, trace, valid}) {
    Mat_VarWrite(file, variable, MAT_COMPRESSION_NONE);
    Mat_VarFree(variable);
  }
  Mat_Close(file);
  const LocalisationTable table = read_table(path("m.mat"), {});
  EXPECT_THAT(table.formats, ElementsAre("minflux_mat"));
  ASSERT_EQ(table.size(), 5u);
  EXPECT_NEAR(table.position_nm[4][0], 4, 1e-9);
  EXPECT_NEAR(table.position_nm[4][1], 14, 1e-9);
  EXPECT_NEAR(table.covariance_nm2[0][0], 2.5, 1e-5);
}

class SmlmArchive : public VendorBinary {
 protected:
  std::string archive(const std::string& manifest, const std::string& table) const {
    const std::string file = path("a.smlm");
    std::filesystem::remove(file);
    int code = 0;
    zip_t* zip = zip_open(file.c_str(), ZIP_CREATE, &code);
    zip_file_add(zip, "manifest.json", zip_source_buffer(zip, manifest.data(), manifest.size(), 0), 0);
    zip_file_add(zip, "t.bin", zip_source_buffer(zip, table.data(), table.size(), 0), 0);
    zip_close(zip);
    return file;
  }
  static std::string manifest(int rows) {
    return R"({"format_version": "0.2", "formats": {"f": {"type": "table", "mode": "binary", "columns": 4,
      "headers": ["x", "y", "x_precision", "y_precision"], "dtype": ["float32", "float64", "uint8", "uint8"],
      "shape": [1, 1, 1, 1], "units": ["um", "", "nm", "nm"]}},
      "files": [{"name": "t.bin", "type": "table", "format": "f", "rows": ")" +
           std::to_string(rows) + R"(", "offset": {"y": 1000}}]})";
  }
  static std::string row(float x, double y, std::uint8_t sigma) {
    std::string bytes(reinterpret_cast<const char*>(&x), 4);
    bytes.append(reinterpret_cast<const char*>(&y), 8);
    return bytes + std::string(2, static_cast<char>(sigma));
  }
};

TEST_F(SmlmArchive, OffsetsAndUnitsAreApplied) {
  const LocalisationTable table = read_table(archive(manifest(2), row(2, 5, 3) + row(4, 6, 3)), {});
  EXPECT_THAT(table.formats, ElementsAre("smlm"));
  EXPECT_THAT(table.position_nm[1], ElementsAre(4000, 1006, 0));
  EXPECT_FLOAT_EQ(table.covariance_nm2[0][0], 9);
  EXPECT_EQ(
      test::error_of([&] { read_table(archive(manifest(3), row(2, 5, 3) + row(4, 6, 3)), {}); }).fault(),
      Fault::input);
  EXPECT_EQ(test::error_of([&] { read_table(archive("[]", ""), {}); }).fault(), Fault::input);
  EXPECT_EQ(
      test::error_of([&] { read_table(archive("{\"files\": [{\"type\": \"table\"}]}", ""), {}); }).fault(),
      Fault::input);
  SMLM_SHARED_FILE(real, "formats/locan_SMLM_dstorm_data.smlm");
  const LocalisationTable dstorm = read_table(real, {});
  EXPECT_EQ(dstorm.size(), 10u);
  EXPECT_NEAR(dstorm.position_nm[0][0], 1653.34, 1e-2);
}

// Flipped bits may leave a table, or give an error; they never end the process.
TEST_F(VendorBinary, FlippedBitsNeverEndTheProcess) {
  {
    h5::File file = h5::File::create(path("h.hdf5"));
    const std::vector<float> ones(5, 1.F);
    const std::vector<float> x{1, 2, 3, 4, 5};
    file.write_table("/locs",
                     {h5::table_column("x", x), h5::table_column("y", x), h5::table_column("lpx", ones),
                      h5::table_column("lpy", ones), h5::table_column("group", ones)});
    file.close();
  }
  write_particles_v5(path("p.mat"), "particles", "points");
  write("m.npy", minflux_npy(10));
  ReadOptions options;
  options.pixel_size_nm = 100;
  std::uint64_t random = 1;
  const auto next = [&random] {
    return (random = random * 6364136223846793005ULL + 1442695040888963407ULL) >> 33;
  };
  for (const char* name : {"h.hdf5", "p.mat", "m.npy"}) {
    std::ifstream source(path(name), std::ios::binary);
    const std::string whole{std::istreambuf_iterator<char>(source), {}};
    int refused = 0;
    for (int trial = 0; trial < 40; ++trial) {
      std::string bytes = whole;
      for (int flip = 0; flip < 3; ++flip) bytes[next() % bytes.size()] ^= static_cast<char>(1 << next() % 8);
      try {
        EXPECT_LE(read_table(write("flipped", bytes), options).size(), 1000u);
      } catch (const Error& error) {
        ++refused;
        EXPECT_TRUE(error.fault() == Fault::input || error.fault() == Fault::resource) << error.what();
      }
    }
    EXPECT_GT(refused, 0) << name;
  }
}

TEST_F(VendorBinary, PyminfluxProjectsAreNamed) {
  {
    h5::File file = h5::File::create(path("p.pmx"));
    file.write<double>("/paraview/dataframe", {1, 2}, {1, 2});
    file.close();
  }
  EXPECT_THAT(test::error_of([&] { read_table(path("p.pmx"), {}); }).what(), HasSubstr("pyMINFLUX"));
}

}  // namespace
}  // namespace smlm

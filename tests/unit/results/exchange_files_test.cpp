// Files for other programs: what they hold, and that this program's own readers get the same table back.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tiffio.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>

#include "polar/results/picasso.hpp"
#include "polar/results/ply.hpp"
#include "polar/results/thunderstorm.hpp"
#include "polar/results/tiff.hpp"
#include "smlm/atomic_file.hpp"
#include "smlm/table_reader.hpp"
#include "support/temporary_directory.hpp"

namespace polar {
namespace {

using ::testing::HasSubstr;

// Two particles, rotated covariances, columns of the input under the names of two programs.
smlm::LocalisationTable example(bool planar = false) {
  smlm::LocalisationTable t;
  t.planar = planar;
  for (int i = 0; i < 40; ++i) {
    const double a = 0.7 * i;
    t.position_nm.push_back({60 * std::cos(a) - 3, 45 * std::sin(a) + 1, planar ? 0.0 : 0.31 * i - 6});
    t.covariance_nm2.push_back(
        {4 + 0.1f * float(i), 0.5f, planar ? 0.0f : -0.3f, 9, planar ? 0.0f : 0.2f, 25});
    t.particle.push_back(i % 2);
    t.source_file.push_back(0);
    t.source_row.push_back(static_cast<std::uint64_t>(i + 1));
  }
  t.particle_names = {"17", "4"};
  t.files = {"a.csv"};
  for (const char* name : {"frame", "photons", "bg"}) {
    t.extra.push_back({name, "", {}, {}});
    for (int i = 0; i < 40; ++i) t.extra.back().values.push_back(i + (name[0] == 'p' ? 500 : 3));
  }
  return t;
}

std::string bytes_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

const smlm::ExtraColumn& column(const smlm::LocalisationTable& t, const std::string& start) {
  for (const smlm::ExtraColumn& c : t.extra)
    if (c.name.rfind(start, 0) == 0) return c;
  throw std::runtime_error("no column " + start);
}

// Lateral position without its mean, which a format may shift.
std::array<double, 2> mean_xy(const smlm::LocalisationTable& t) {
  std::array<double, 2> mean{};
  for (const auto& x : t.position_nm)
    for (std::size_t axis = 0; axis < 2; ++axis) mean[axis] += x[axis] / static_cast<double>(t.size());
  return mean;
}

TEST(ThunderStormCsv, ReadsBackWithinItsFourDecimals) {
  for (const bool planar : {false, true}) {
    const support::TemporaryDirectory directory;
    const smlm::LocalisationTable t = example(planar);
    smlm::write_file_atomically(directory.path("a.csv"), format_thunderstorm_csv(t));
    const smlm::LocalisationTable back = smlm::read_table(directory.path("a.csv"), {});
    EXPECT_EQ(back.formats, std::vector<std::string>{"thunderstorm"});
    EXPECT_EQ(back.planar, planar);
    EXPECT_EQ(back.particle_names, t.particle_names);
    EXPECT_EQ(back.particle, t.particle);
    ASSERT_EQ(back.size(), t.size());
    for (std::size_t i = 0; i < t.size(); ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(back.position_nm[i][axis], t.position_nm[i][axis], 0.5001e-4);
      const auto& c = t.covariance_nm2[i];
      EXPECT_NEAR(std::sqrt(double(back.covariance_nm2[i][0])), std::sqrt((double(c[0]) + double(c[3])) / 2),
                  1e-4);
      if (!planar) {
        EXPECT_NEAR(std::sqrt(double(back.covariance_nm2[i][5])), 5, 1e-4);
      }
    }
    EXPECT_EQ(column(back, "frame").values, t.extra[0].values);
    EXPECT_EQ(column(back, "intensity").values, t.extra[1].values);
    EXPECT_EQ(column(back, "offset").values, t.extra[2].values);
  }
}

TEST(ThunderStormCsv, FramesCountFromOne) {
  smlm::LocalisationTable t = example();
  t.extra[0].values.assign(t.size(), 0.0);
  EXPECT_THAT(format_thunderstorm_csv(t), HasSubstr("\n1,1,"));
  t.extra[0].values.assign(t.size(), 7.0);
  EXPECT_THAT(format_thunderstorm_csv(t), HasSubstr("\n1,7,"));
  t.extra.clear();
  EXPECT_THAT(format_thunderstorm_csv(t), HasSubstr("\n1,1,"));
}

TEST(PicassoFile, ReadsBackWithinSinglePrecision) {
  for (const bool planar : {false, true}) {
    const support::TemporaryDirectory directory;
    const smlm::LocalisationTable t = example(planar);
    const auto shift = picasso_shift_nm(t);
    EXPECT_GT(shift[0], 0);  // the example has negative coordinates, which Picasso would drop
    write_picasso(directory.path("a.hdf5"), t, shift);
    const smlm::LocalisationTable back = smlm::read_table(directory.path("a.hdf5"), {});
    EXPECT_EQ(back.formats, std::vector<std::string>{"picasso"});
    EXPECT_EQ(back.particle_names, t.particle_names);
    EXPECT_EQ(back.particle, t.particle);
    ASSERT_EQ(back.size(), t.size());
    const auto mean = mean_xy(t), mean_back = mean_xy(back);
    for (std::size_t axis = 0; axis < 2; ++axis) EXPECT_NEAR(mean_back[axis], mean[axis] + shift[axis], 1e-4);
    const double pixel_rounding_nm = 8 * 0x1p-24 * kPicassoPixel_nm;  // of a float below 8 pixels
    for (std::size_t i = 0; i < t.size(); ++i) {
      for (std::size_t axis = 0; axis < 2; ++axis) {
        EXPECT_GE(back.position_nm[i][axis], 0);
        EXPECT_NEAR(back.position_nm[i][axis], t.position_nm[i][axis] + shift[axis], pixel_rounding_nm);
      }
      EXPECT_NEAR(back.position_nm[i][2], t.position_nm[i][2], 1e-6);
      for (const std::size_t e : {0u, 3u})
        EXPECT_NEAR(double(back.covariance_nm2[i][e]), double(t.covariance_nm2[i][e]), 1e-5);
      if (!planar) {
        EXPECT_NEAR(double(back.covariance_nm2[i][5]), 25, 1e-5);
      }
    }
    EXPECT_EQ(column(back, "frame").values, t.extra[0].values);
    EXPECT_EQ(column(back, "photons").values, t.extra[1].values);
    EXPECT_EQ(column(back, "bg").values, t.extra[2].values);
  }
}

TEST(PicassoFile, SidecarSaysWhatWasDone) {
  const support::TemporaryDirectory directory;
  write_picasso(directory.path("a.hdf5"), example(), {250, 260.5});
  const std::string text = bytes_of(directory.path("a.yaml"));
  EXPECT_THAT(text, HasSubstr("Pixelsize: 130\nWidth: 5\n---\n"));  // 57 + 250 + margin of 260 nm
  EXPECT_THAT(text, HasSubstr("Number of particles: 2\nShift x (nm): 250\nShift y (nm): 260.5\n"));
}

float float_at(const std::string& bytes, std::size_t at) {
  float value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof value);  // the tests run on little-endian machines
  return value;
}

TEST(Ply, HoldsPositionsSigmasParticlesAndWeights) {
  const support::TemporaryDirectory directory;
  const smlm::LocalisationTable t = example();
  write_ply(directory.path("a.ply"), t);
  const std::string bytes = bytes_of(directory.path("a.ply"));
  EXPECT_EQ(bytes.rfind("ply\nformat binary_little_endian 1.0\n", 0), 0u);
  EXPECT_THAT(bytes, HasSubstr("element vertex 40\nproperty float x\n"));
  const std::string end = "end_header\n";
  const std::size_t body = bytes.find(end) + end.size();
  constexpr std::size_t kVertex = 8 * 4;
  ASSERT_EQ(bytes.size(), body + 40 * kVertex);
  const std::size_t last = body + 39 * kVertex;
  EXPECT_FLOAT_EQ(float_at(bytes, last + 8), static_cast<float>(t.position_nm[39][2]));
  EXPECT_FLOAT_EQ(float_at(bytes, last + 12), std::sqrt(7.9f));
  EXPECT_FLOAT_EQ(float_at(bytes, last + 20), 5);
  std::int32_t particle = -1;
  std::memcpy(&particle, bytes.data() + last + 24, sizeof particle);
  EXPECT_EQ(particle, 1);
  EXPECT_FLOAT_EQ(float_at(bytes, body + 28), 1);  // the first is the most precise one
  EXPECT_FLOAT_EQ(float_at(bytes, last + 28), static_cast<float>(std::cbrt(4 / 7.9)));
}

TEST(ImageJTiff, HoldsTheVolumeAndItsCalibration) {
  const support::TemporaryDirectory directory;
  Volume v{{3, 2, 4}, {-5, 1, 2}, 2.5, false, {}};
  for (int i = 0; i < 24; ++i) v.density.push_back(0.125f * float(i));
  write_imagej_tiff(directory.path("a.tif"), {v});
  const std::unique_ptr<TIFF, decltype(&TIFFClose)> file(TIFFOpen(directory.path("a.tif").c_str(), "r"),
                                                         &TIFFClose);
  ASSERT_TRUE(file);
  const char* description = nullptr;
  float resolution = 0;
  ASSERT_EQ(TIFFGetField(file.get(), TIFFTAG_IMAGEDESCRIPTION, &description), 1);
  ASSERT_EQ(TIFFGetField(file.get(), TIFFTAG_XRESOLUTION, &resolution), 1);
  EXPECT_FLOAT_EQ(resolution, 0.4f);
  EXPECT_STREQ(description,
               "ImageJ=1.53t\nslices=4\nunit=nm\nspacing=2.5\nloop=false\nmin=0\nmax=2.875\n"
               "xorigin=2\nyorigin=-0.4\nzorigin=-0.8\n");
  std::vector<float> read;
  do {
    std::vector<float> slice(6);
    ASSERT_EQ(TIFFReadEncodedStrip(file.get(), 0, slice.data(), -1), 24);
    read.insert(read.end(), slice.begin(), slice.end());
  } while (TIFFReadDirectory(file.get()) == 1);
  EXPECT_EQ(read, v.density);
}

TEST(ImageJTiff, PlanarVolumeIsOneSlice) {
  const support::TemporaryDirectory directory;
  write_imagej_tiff(directory.path("a.tif"), {Volume{{2, 1, 1}, {0, 0, 0}, 1, true, {0.0f, 3.0f}}});
  const std::unique_ptr<TIFF, decltype(&TIFFClose)> file(TIFFOpen(directory.path("a.tif").c_str(), "r"),
                                                         &TIFFClose);
  ASSERT_TRUE(file);
  EXPECT_EQ(TIFFNumberOfDirectories(file.get()), 1);
}

}  // namespace
}  // namespace polar

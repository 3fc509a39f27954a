#include "polar/results/tiff.hpp"

#include <tiffio.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <memory>

#include "smlm/atomic_file.hpp"
#include "smlm/error.hpp"

namespace polar {

namespace {
// Classic TIFF addresses 4 GiB; ImageJ 1.53 opens nothing larger. Tags and offsets need little beside.
constexpr std::size_t kMostBytes = std::size_t{4} * 1024 * 1024 * 1024 - (std::size_t{1} << 24);
constexpr int kBitsPerSample = 32;

struct Close {
  void operator()(TIFF* file) const { TIFFClose(file); }
};
using File = std::unique_ptr<TIFF, Close>;

[[noreturn]] void fail(const std::string& path, const std::string& what) {
  throw smlm::Error(smlm::Fault::io, path, what, "check space and permissions");
}

// Nine significant digits, which is what a float needs, in any locale.
std::string number(double value) {
  constexpr int kDigits = std::numeric_limits<float>::max_digits10;
  std::array<char, 32> digits{};
  const auto end =
      std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::general, kDigits);
  return {digits.data(), end.ptr};
}

// The keys that ImageJ's FileSaver writes and its opener understands (ij/io/FileSaver.java), but not
// "images": where that is given, ImageJ takes the slices to follow the first without a gap and reads the
// directories between them as pixels. The origin is where x = y = z = 0 lies in pixels: measured = (pixel -
// origin) * size with voxel centres at whole numbers.
std::string description(const std::vector<Volume>& channels) {
  const Volume& v = channels.front();
  const auto [low, high] = std::minmax_element(v.density.begin(), v.density.end());
  std::string text = "ImageJ=1.53t\n";
  if (channels.size() > 1)
    text += "channels=" + std::to_string(channels.size()) + "\nhyperstack=true\nmode=composite\n";
  if (v.size[2] > 1) text += "slices=" + std::to_string(v.size[2]) + "\n";
  text += "unit=nm\nspacing=" + number(v.voxel_nm) + "\nloop=false\n";
  text += "min=" + number(double(*low)) + "\nmax=" + number(double(*high)) + "\n";
  const char* names[] = {"xorigin", "yorigin", "zorigin"};
  for (std::size_t axis = 0; axis < 3; ++axis)
    text += std::string(names[axis]) + "=" + number(-v.origin_nm[axis] / v.voxel_nm) + "\n";
  return text;
}

bool write_slice(TIFF* file, const Volume& v, std::size_t z, const std::string& heading) {
  const auto width = static_cast<std::uint32_t>(v.size[0]), height = static_cast<std::uint32_t>(v.size[1]);
  const float pixels_per_nm = static_cast<float>(1 / v.voxel_nm);
  bool good =
      TIFFSetField(file, TIFFTAG_IMAGEWIDTH, width) == 1 &&
      TIFFSetField(file, TIFFTAG_IMAGELENGTH, height) == 1 &&
      TIFFSetField(file, TIFFTAG_BITSPERSAMPLE, kBitsPerSample) == 1 &&
      TIFFSetField(file, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_IEEEFP) == 1 &&
      TIFFSetField(file, TIFFTAG_SAMPLESPERPIXEL, 1) == 1 &&
      TIFFSetField(file, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK) == 1 &&
      TIFFSetField(file, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG) == 1 &&
      TIFFSetField(file, TIFFTAG_COMPRESSION, COMPRESSION_NONE) == 1 &&
      TIFFSetField(file, TIFFTAG_ROWSPERSTRIP, height) == 1 &&
      TIFFSetField(file, TIFFTAG_RESOLUTIONUNIT, RESUNIT_NONE) == 1 &&  // the description has the unit
      TIFFSetField(file, TIFFTAG_XRESOLUTION, pixels_per_nm) == 1 &&
      TIFFSetField(file, TIFFTAG_YRESOLUTION, pixels_per_nm) == 1;
  if (!heading.empty()) good = good && TIFFSetField(file, TIFFTAG_IMAGEDESCRIPTION, heading.c_str()) == 1;
  const std::size_t pixels = v.size[0] * v.size[1];
  std::vector<float> slice(v.density.begin() + static_cast<std::ptrdiff_t>(z * pixels),
                           v.density.begin() + static_cast<std::ptrdiff_t>((z + 1) * pixels));
  const auto bytes = static_cast<tmsize_t>(pixels * sizeof(float));
  return good && TIFFWriteEncodedStrip(file, 0, slice.data(), bytes) == bytes &&
         TIFFWriteDirectory(file) == 1;
}
}  // namespace

void write_imagej_tiff(const std::string& path, const std::vector<Volume>& channels) {
  const Volume& first = channels.front();
  if (channels.size() * first.density.size() * sizeof(float) > kMostBytes)
    throw smlm::Error(smlm::Fault::io, path, "a stack of more than 4 GiB is no TIFF",
                      "choose a larger voxel");
  TIFFSetErrorHandler(nullptr);  // it prints; what failed is said here
  TIFFSetWarningHandler(nullptr);
  smlm::AtomicFile atomic(path);
  {
    const File file(TIFFOpen(atomic.temporary_path().c_str(), "wl"));  // little endian on any machine
    if (!file) fail(path, "the stack cannot be opened");
    std::string heading = description(channels);
    for (std::size_t z = 0; z < first.size[2]; ++z)
      for (const Volume& channel : channels) {
        if (!write_slice(file.get(), channel, z, heading))
          fail(path, "writing slice " + std::to_string(z) + " failed");
        heading.clear();
      }
  }
  atomic.commit();
}

}  // namespace polar

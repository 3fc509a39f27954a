#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "polar/core/constants.hpp"
#include "report/bars.hpp"
#include "report/base64.hpp"
#include "report/contour.hpp"
#include "report/histogram.hpp"
#include "report/interval.hpp"
#include "report/plot.hpp"
#include "report/raster.hpp"
#include "report/text.hpp"

namespace polar::report {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::size_t occurrences(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

TEST(ReportText, NumbersAsAReaderWantsThem) {
  EXPECT_EQ(digits(0), "0");
  EXPECT_EQ(digits(1234.6), "1235");
  EXPECT_EQ(digits(12.345), "12.3");
  EXPECT_EQ(digits(0.012345), "0.0123");
  EXPECT_EQ(digits(-3.14159), "-3.14");
  EXPECT_EQ(digits(1e-7), "1e-07");
  EXPECT_EQ(digits(std::nan("")), "none");
  EXPECT_EQ(fixed(-0.0001, 1), "0.0");
  EXPECT_EQ(percent(0.417, 1), "41.7 %");
  EXPECT_EQ(counted(1, "particle"), "1 particle");
  EXPECT_EQ(counted(0, "particle"), "0 particles");
  EXPECT_EQ(duration(12.34), "12.3 s");
  EXPECT_EQ(duration(600), "10 min 0 s");
  EXPECT_EQ(duration(7260), "2 h 1 min");
}

TEST(ReportText, BytesThatAreNoUtf8AreReplaced) {
  EXPECT_EQ(utf8("5 \xC2\xB5m"), "5 \xC2\xB5m");
  EXPECT_EQ(utf8("a\xFF\x62"), "a\xEF\xBF\xBD\x62");
  EXPECT_EQ(utf8("a\xC3"), "a\xEF\xBF\xBD");  // cut off
  EXPECT_EQ(utf8(std::string("a\0b", 3)), "a\xEF\xBF\xBD\x62");
}

TEST(ReportText, Base64OfTheStandard) {  // RFC 4648, section 10
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
}

TEST(ReportHistogram, CountsEveryFiniteValueOnce) {
  std::vector<double> values = {std::nan(""), INFINITY};
  for (int i = 0; i < 1000; ++i) values.push_back(0.01 * i);
  values.push_back(1e6);  // far away: does not set the axis
  const Histogram h = histogram(values);
  EXPECT_EQ(h.total, 1001u);
  EXPECT_EQ(h.above, 1u);
  EXPECT_LT(h.high(), 20);
  std::size_t sum = 0;
  for (const std::size_t c : h.count) sum += c;
  EXPECT_EQ(sum, h.total);
  EXPECT_TRUE(histogram({}).count.empty());
  EXPECT_EQ(histogram({3, 3, 3}).total, 3u);
  const Histogram whole = whole_number_histogram({0, 1, 1, 3});
  EXPECT_EQ(whole.count, (std::vector<std::size_t>{1, 2, 0, 1}));
}

TEST(ReportHistogram, StepsAreRound) {
  EXPECT_DOUBLE_EQ(round_step(0.3), 0.5);
  EXPECT_DOUBLE_EQ(round_step(5), 5);
  EXPECT_DOUBLE_EQ(round_step(5.1), 10);
  EXPECT_DOUBLE_EQ(round_step(0), 1);
}

TEST(ReportPlot, DrawsWhatItIsGivenAndBreaksAtHoles) {
  Plot plot({0, 10, "x <nm>"}, {0, 1, "y"});
  plot.line("c1", {0, 5, 6, 10}, {0, std::nan(""), 0.5, 1});
  const std::string svg = plot.svg("a \"plot\"");
  EXPECT_THAT(svg, HasSubstr("x &lt;nm&gt;"));
  EXPECT_THAT(svg, HasSubstr("a &quot;plot&quot;"));
  // The line's own path begins anew behind the hole, and ends in the upper right corner.
  EXPECT_THAT(svg, HasSubstr("class=\"line c1\" d=\"M46 192M227.2 109L348 26\""));
}

TEST(ReportPlot, AHistogramHasABarForEveryFilledBin) {
  const Histogram h = histogram_between({0.5, 0.5, 2.5}, 0, 4, 4);
  const std::string svg = histogram_svg(h, "value", "particles", "c1", {{3, "cut"}});
  EXPECT_EQ(occurrences(svg, "class=\"fill c1\""), 2u);
  EXPECT_THAT(svg, HasSubstr("0 to 1.000: 2"));
  EXPECT_THAT(svg, HasSubstr(">cut<"));
  EXPECT_THAT(svg, HasSubstr("histogram of 3 values"));
}

TEST(ReportPlot, BarsHaveTheirNamesValuesAndIntervals) {
  const std::string svg = bars_svg({{"one & only", 2, "2 s"}, {"two", 4, "4 s", 3, 5}}, "seconds");
  EXPECT_THAT(svg, HasSubstr("one &amp; only"));
  EXPECT_EQ(occurrences(svg, "class=\"interval\""), 1u);
  EXPECT_EQ(occurrences(svg, "class=\"fill c1\""), 2u);
}

Volume disc(double radius_nm) {
  Volume v;
  v.size = {41, 41, 1}, v.voxel_nm = 1, v.origin_nm = {-20, -20, 0}, v.planar = true;
  v.density.resize(41 * 41);
  for (std::size_t y = 0; y < 41; ++y)
    for (std::size_t x = 0; x < 41; ++x)
      v.density[y * 41 + x] = static_cast<float>(
          radius_nm - std::hypot(static_cast<double>(x) - 20, static_cast<double>(y) - 20));
  return v;
}

TEST(ReportContour, OfADiscIsItsRim) {
  const auto segments = contour(projected(disc(12), kTopView), 0);
  ASSERT_GT(segments.size(), 40u);
  double length = 0;
  for (const auto& s : segments) {
    EXPECT_NEAR(std::hypot(s[0], s[1]), 12, 0.1);
    length += std::hypot(s[2] - s[0], s[3] - s[1]);
  }
  EXPECT_NEAR(length, kTwoPi * 12, 1);
}

TEST(ReportRaster, ProjectionsKeepTheSum) {
  Volume v;
  v.size = {2, 3, 4};
  for (int i = 0; i < 24; ++i) v.density.push_back(static_cast<float>(i));
  for (const Plane& plane : {kTopView, kFrontView, kSideView}) {
    const Raster r = projected(v, plane);
    double sum = 0;
    for (const double value : r.value) sum += value;
    EXPECT_DOUBLE_EQ(sum, 276);
  }
  EXPECT_DOUBLE_EQ(summed(v, kTopView, 3, 4).value[0], 18);
  const std::string svg =
      picture_svg(projected(v, kTopView), heat_png(projected(v, kTopView), 1), "xy", "a picture");
  EXPECT_THAT(svg, HasSubstr("data:image/png;base64,iVBORw0KGgo"));
  EXPECT_THAT(svg, HasSubstr(" nm<"));  // the scale bar's length
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
}

TEST(ReportInterval, OfWilson) {  // R. G. Newcombe, Statist. Med. 17, 857-872, 1998, table I
  EXPECT_NEAR(wilson(81.0 / 263, 263).low, 0.2553, 1e-4);
  EXPECT_NEAR(wilson(81.0 / 263, 263).high, 0.3662, 1e-4);
  EXPECT_NEAR(wilson(0, 20).high, 0.1611, 1e-4);
  EXPECT_DOUBLE_EQ(wilson(0, 20).low, 0);
}

}  // namespace
}  // namespace polar::report

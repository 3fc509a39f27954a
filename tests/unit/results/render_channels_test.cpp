#include <gtest/gtest.h>

#include "polar/results/preview.hpp"
#include "polar/results/render.hpp"
#include "polar/results/vtkhdf.hpp"
#include "smlm/h5/file.hpp"
#include "support/temporary_directory.hpp"

namespace polar {
namespace {

smlm::LocalisationTable two_colours() {
  smlm::LocalisationTable t;
  t.particle_names = {"a"};
  t.extra = {{"channel", "", {1, 2, 1, 2}, {}}};
  for (const double x : {0.0, 10.0, 20.0, 30.0}) {
    t.position_nm.push_back({x, 5, 5});
    t.covariance_nm2.push_back({4, 0, 0, 4, 0, 4});
    t.particle.push_back(0);
  }
  return t;
}

TEST(RenderChannels, SumToTheWholeInOneBox) {
  RenderOptions options;
  EXPECT_TRUE(render_channels(two_colours(), options).empty());
  options.channel_column = "channel";
  const Volume whole = render(two_colours(), options);
  const std::vector<ChannelVolume> channels = render_channels(two_colours(), options);
  ASSERT_EQ(channels.size(), 2u);
  EXPECT_EQ(channels[1].name, "2");
  EXPECT_EQ(channels[0].volume.size, whole.size);
  double difference = 0, first = 0, second = 0;
  for (std::size_t i = 0; i < whole.density.size(); ++i) {
    const double a = double(channels[0].volume.density[i]), b = double(channels[1].volume.density[i]);
    difference = std::max(difference, std::abs(a + b - double(whole.density[i])));
    first += a, second += b;
  }
  EXPECT_LT(difference, 1e-6 * double(*std::max_element(whole.density.begin(), whole.density.end())));
  EXPECT_GT(first, 0);
  EXPECT_NEAR(first / second, 1, 0.1);
}

TEST(RenderChannels, AreArraysOfOneFileAndColoursOfOnePicture) {
  const support::TemporaryDirectory directory;
  RenderOptions options;
  options.channel_column = "channel";
  const std::vector<ChannelVolume> channels = render_channels(two_colours(), options);
  write_volume_vtkhdf(directory.path("t.hdf"), render(two_colours(), options), channels);
  const smlm::h5::File file = smlm::h5::File::open(directory.path("t.hdf"));
  EXPECT_EQ(file.read<float>("/VTKHDF/PointData/density_2"), channels[1].volume.density);
  write_preview_png(directory.path("two.png"), channels);
  write_preview_png(directory.path("one.png"), {{"", render(two_colours(), options)}});
  EXPECT_NE(std::filesystem::file_size(directory.path("two.png")),
            std::filesystem::file_size(directory.path("one.png")));
}

}  // namespace
}  // namespace polar

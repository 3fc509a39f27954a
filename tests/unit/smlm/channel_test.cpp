#include "smlm/channel.hpp"

#include <gmock/gmock.h>

#include "fixture.hpp"
#include "smlm/table_reader.hpp"

namespace smlm {
namespace {

using test::error_of;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class Channel : public test::TemporaryFolder {
 protected:
  std::string colours() const {
    return write(
        "c.csv",
        "x,y,sigma_xy,channel,dye,particle\n1,2,3,2,red,a\n1,2,3,1,green,a\n1,2,3,2,red,b\n1,2,3,,,b\n");
  }
};

TEST_F(Channel, AreTheValuesOfAColumn) {
  const LocalisationTable t = read_table(colours(), {});
  const Channels numbers = channels_of(t, "channel");
  EXPECT_THAT(numbers.names, ElementsAre("1", "2"));
  EXPECT_THAT(numbers.row, ElementsAre(1, 0, 1, -1));
  EXPECT_THAT(channels_of(t, "dye").names, ElementsAre("red", "green"));
  EXPECT_THAT(registering_channels(numbers, {"channel", false, {}}), ElementsAre(true, false));
  EXPECT_THAT(registering_channels(numbers, {"channel", false, {"2"}}), ElementsAre(false, true));
}

TEST_F(Channel, FaultsNameTheChannelsThatThereAre) {
  const LocalisationTable t = read_table(colours(), {});
  EXPECT_THAT(error_of([&] { channels_of(t, "colour"); }).what(), HasSubstr("the columns are channel, dye"));
  const Error unknown = error_of([&] {
    registering_channels(channels_of(t, "dye"), {"dye", false, {"blue"}});
  });
  EXPECT_EQ(unknown.exit_code(), 3);
  EXPECT_THAT(unknown.what(), HasSubstr("the channels are red, green"));
  std::string many = "x,y,sigma_xy,photons,particle\n";
  for (int i = 0; i < 20; ++i) many += "1,2,3," + std::to_string(i) + ",a\n";
  EXPECT_THAT(error_of([&] { channels_of(read_table(write("m.csv", many), {}), "photons"); }).what(),
              HasSubstr("more than 16 different values"));
  EXPECT_EQ(violations(ChannelOptions{"a", true, {}}).size(), 1u);
  EXPECT_EQ(violations(ChannelOptions{"", false, {"1"}}).size(), 1u);
}

TEST_F(Channel, FilesOfTheSameParticlesAreChannels) {
  const std::string green = write("green.csv", "x,y,sigma_xy,particle\n1,2,3,a\n2,2,3,b\n");
  const std::string red = write("red.csv", "x,y,sigma_xy,particle\n3,2,3,b\n4,2,3,c\n5,2,3,a\n");
  ReadOptions options;
  options.channel.per_file = true;
  const LocalisationTable t = read_tables({green, red}, options);
  EXPECT_THAT(t.particle_names, ElementsAre("a", "b", "c"));
  EXPECT_THAT(t.particle, ElementsAre(0, 1, 1, 2, 0));
  const Channels channels = channels_of(t, channel_column(options.channel));
  EXPECT_THAT(channels.names, ElementsAre("green", "red"));
  EXPECT_THAT(channels.row, ElementsAre(0, 0, 1, 1, 1));
  options.particles = "one_per_file";
  EXPECT_THAT(error_of([&] {
                read_tables({green, red}, options);
              }).what(),
              HasSubstr("no particles in common"));
}

}  // namespace
}  // namespace smlm

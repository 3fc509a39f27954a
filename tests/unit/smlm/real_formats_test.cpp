// Every real file of other programs is read as what it is, or refused with a line that says what to do.
#include <gmock/gmock.h>

#include <set>

#include "fixture.hpp"
#include "smlm/table_reader.hpp"

namespace smlm {
namespace {

struct Expected {
  const char* file;
  const char* format;  // empty: refused
  std::size_t rows;
  const char* message;
};

const std::vector<Expected> expected{
    {"README.txt", "", 0, "README.txt:38: has 7 fields where the header has 26"},
    {"locan_Elyra_dstorm_data.txt", "elyra", 15, ""},
    {"locan_Nanoimager_dstorm_data.csv", "oni", 14, ""},
    {"locan_SMLM_dstorm_data.smlm", "smlm", 10, ""},
    {"locan_Thunderstorm_dstorm_data.csv", "thunderstorm", 19, ""},
    {"locan_decode_dstorm_data.h5", "decode", 96, ""},
    {"locan_decode_dstorm_data_empty.h5", "decode", 0, ""},
    {"locan_five_blobs.txt", "csv", 50, ""},
    {"locan_five_blobs_3D.txt", "csv", 50, ""},
    {"locan_npc_gp210.asdf", "", 0, "ASDF"},
    {"locan_rapidSTORM_dstorm_data.txt", "rapidstorm", 14, ""},
    {"locan_rapidSTORM_dstorm_track_data.txt", "rapidstorm", 14, ""},
    {"locan_rapidSTORM_from_images.txt", "rapidstorm", 12, ""},
    {"locan_smap_dstorm_data.mat", "smap", 4884, ""},
    {"picasso_origami_simulated_locs.hdf5", "picasso", 60722, ""},
    {"picasso_origami_simulated_locs.yaml", "", 0, "YAML"},
    {"picasso_raw_movie_locs_picked.hdf5", "picasso", 2378, ""},
    {"picasso_raw_movie_locs_picked.yaml", "", 0, "YAML"},
    {"picasso_testdata_locs.hdf5", "picasso", 564, ""},
    {"picasso_testdata_locs.yaml", "", 0, "YAML"},
    {"pyminflux_2D_ValidOnly.npy.zip", "", 0, "unpack it first"},
    {"pyminflux_3D_ValidOnly.npy.zip", "", 0, "unpack it first"},
    {"pyminflux_Fig2_U2OS_Tom70-Dreiklang_ATP5B_AB_Minflux3D.csv", "", 0, "has no header"},
    {"pyminflux_aggregates.npy.zip", "", 0, "unpack it first"},
    {"pyminflux_pmx_format_versions.zip", "", 0, "unpack it first"},
    {"rapidstorm_like_HAmOrange_ROI.csv", "thunderstorm", 2765, ""},
    {"smap_locmofit_example_ring_data.csv", "csv", 40, ""},
    {"smap_locmofit_example_spcap_data.csv", "csv", 44, ""},
    {"smap_locmofit_simulated_data_npc.csv", "csv", 66, ""},
    {"smlm_challenge_MT1.N1.HD-AS.csv", "thunderstorm", 8935, ""},
    {"thunderstorm_3d.csv", "thunderstorm", 11195, ""},
    {"thunderstorm_microtubule_RiesLab.csv", "csv", 2848, ""},
    {"vlume_caulobacter_R09.csv", "csv", 8759, ""},
};

TEST(RealFormats, EachIsReadOrRefused) {
  SMLM_SHARED_FILE(folder, "formats");
  for (const Expected& e : expected) {
    const std::string file = folder + "/" + e.file;
    if (*e.format != '\0') {
      const LocalisationTable table = read_table(file, {});
      EXPECT_EQ(table.formats.front(), e.format) << file;
      EXPECT_EQ(table.size(), e.rows) << file;
      EXPECT_TRUE(table.rejected.empty()) << file;
    } else {
      const Error error = test::error_of([&] { read_table(file, {}); });
      EXPECT_EQ(error.fault(), Fault::input) << file;
      EXPECT_THAT(error.what(), ::testing::HasSubstr(e.message));
      EXPECT_THAT(error.what(), ::testing::Not(::testing::HasSubstr("\n")));
    }
  }
}

TEST(RealFormats, NoneIsForgotten) {
  SMLM_SHARED_FILE(folder, "formats");
  std::set<std::string> listed;
  for (const Expected& e : expected) listed.insert(e.file);
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    EXPECT_EQ(listed.count(entry.path().filename().string()), 1u) << entry.path();
  }
}

TEST(RealFormats, AHeaderlessTableIsReadOnceItsColumnsAreNumbered) {
  SMLM_SHARED_FILE(file, "formats/pyminflux_Fig2_U2OS_Tom70-Dreiklang_ATP5B_AB_Minflux3D.csv");
  ReadOptions options;
  options.columns = {{"x", {"1", "nm", "std"}}, {"y", {"2", "nm", "std"}}, {"z", {"3", "nm", "std"}}};
  const LocalisationTable table = read_table(file, options);
  EXPECT_THAT(table.position_nm[0],
              ::testing::ElementsAre(-308.981447475189, 313.086039127413, -42.2991448974609));
}

}  // namespace
}  // namespace smlm

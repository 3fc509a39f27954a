// The vendors' text tables: real files where there are some, headers as documented where there are none.
#include <gmock/gmock.h>

#include "fixture.hpp"
#include "smlm/table_reader.hpp"

namespace smlm {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class VendorText : public test::TemporaryFolder {};

TEST_F(VendorText, Elyra) {
  // A NUL byte and a footer stand behind the data.
  const std::string text = std::string(
                               "Index\tFirst Frame\tPosition X [nm]\tPosition Y [nm]\tPosition Z "
                               "[nm]\tPrecision [nm]\tNumber Photons\r\n"
                               "1\t1\t100.5\t200\t30\t8\t500\r\n2\t2\t101.5\t200\t31\t9\t500\r\n") +
                           '\0' + "\r\r\nVoxelSizeX : 0.097 \xB5m\r\nROI List : \r\n";
  const LocalisationTable table = read_table(write("e.txt", text), {});
  EXPECT_THAT(table.formats, ElementsAre("elyra"));
  ASSERT_EQ(table.size(), 2u);
  EXPECT_THAT(table.position_nm[1], ElementsAre(101.5, 200, 31));
  EXPECT_FLOAT_EQ(table.covariance_nm2[0][0], 64);
  EXPECT_TRUE(table.axial_sigma_assumed);
  SMLM_SHARED_FILE(real, "formats/locan_Elyra_dstorm_data.txt");
  const LocalisationTable dstorm = read_table(real, {});
  EXPECT_EQ(dstorm.size(), 15u);
  EXPECT_THAT(dstorm.position_nm[14], ElementsAre(5369.8, 8439.4, 0));
  EXPECT_FLOAT_EQ(dstorm.covariance_nm2[0][0], 8.6F * 8.6F);
}

TEST_F(VendorText, NstormUsesTheCorrectedPositions) {
  const std::string header =
      "Channel "
      "Name\tX\tY\tXc\tYc\tHeight\tArea\tWidth\tPhi\tAx\tBG\tI\tFrame\tLength\tLink\tValid\tZ\tZc\tPhotons\t"
      "Lateral Localization Accuracy\tXw\tYw\tXwc\tYwc\tZw\tZwc\r\n";
  const LocalisationTable table =
      read_table(write("n.txt", header +
                                    "647\t1\t2\t10\t20\t1\t1\t300\t0\t1\t5\t9\t1\t1\t-1\t1\t3\t30\t900\t7."
                                    "5\t1\t2\t10\t20\t3\t30\r\n" +
                                    "Z "
                                    "Rejected\t1\t2\t11\t21\t1\t1\t300\t0\t1\t5\t9\t1\t1\t-"
                                    "1\t1\t3\t31\t900\t7.5\t1\t2\t10\t20\t3\t30\r\n"),
                 {});
  EXPECT_THAT(table.formats, ElementsAre("nstorm"));
  EXPECT_THAT(table.position_nm[0], ElementsAre(10, 20, 30));
  EXPECT_FLOAT_EQ(table.covariance_nm2[1][3], 56.25);
}

TEST_F(VendorText, NstormChannelNamesAreKept) {
  const LocalisationTable table = read_table(write("n.txt",
                                                   "Channel Name\tX\tY\tXc\tYc\tLateral Localization "
                                                   "Accuracy\nred\t1\t2\t10\t20\t7\nblue\t1\t2\t11\t20\t7\n"),
                                             {});
  EXPECT_THAT(table.extra[0].labels, ElementsAre("red", "blue"));
}

TEST_F(VendorText, OniTakesNanometresAndPrecisions) {
  const LocalisationTable table = read_table(
      write("o.csv",
            "Channel,Frame,X (nm),Y (nm),Z (nm),X precision (nm),Y precision (nm),X (pix),Y (pix),Z (pix),"
            "X precision (pix),Y precision (pix),Photons,Background\n"
            "0,1,117,234,5,10,12,1,2,0.05,0.09,0.1,500,3\n0,1,118,234,6,10,12,1,2,0.05,0.09,0.1,500,3\n"),
      {});
  EXPECT_THAT(table.formats, ElementsAre("oni"));
  EXPECT_THAT(table.position_nm[0], ElementsAre(117, 234, 5));
  EXPECT_FLOAT_EQ(table.covariance_nm2[0][0], 100);
  EXPECT_FLOAT_EQ(table.covariance_nm2[0][3], 144);
  SMLM_SHARED_FILE(old, "formats/locan_Nanoimager_dstorm_data.csv");
  const LocalisationTable without = read_table(old, {});
  EXPECT_THAT(without.formats, ElementsAre("oni"));
  EXPECT_TRUE(without.sigma_assumed && without.planar);
}

TEST_F(VendorText, ZolaTakesNanometres) {
  const LocalisationTable table =
      read_table(write("z.csv",
                       "frame,x_pix,y_pix,z_nm,intensity,crlb_x,crlb_y,crlb_z,x_nm,y_nm,crlb_xnm,crlb_ynm\n"
                       "1,1,2,30,500,.05,.06,20,100,200,5,6\n1,1,2,31,500,.05,.06,20,100,200,5,6\n"),
                 {});
  EXPECT_THAT(table.formats, ElementsAre("zola"));
  EXPECT_THAT(table.position_nm[0], ElementsAre(100, 200, 30));
  EXPECT_THAT(table.covariance_nm2[0], ElementsAre(25.F, 0.F, 0.F, 36.F, 0.F, 400.F));
}

TEST_F(VendorText, RapidstormReadsItsXmlHeader) {
  const std::string xml =
      "# <localizations insequence=\"true\" repetitions=\"variable\"><field identifier=\"Position-0-0\" "
      "unit=\"nanometer\" "
      "/><field identifier=\"Position-0-0-uncertainty\" unit=\"nanometer\" /><field "
      "identifier=\"Position-1-0\" unit=\"micrometer\" "
      "/><field identifier=\"Position-1-0-uncertainty\" unit=\"nanometer\" /></localizations>\n";
  const LocalisationTable table = read_table(write("r.txt", xml + "10.5 4 2 3\n11 4 2 3\n"), {});
  EXPECT_THAT(table.formats, ElementsAre("rapidstorm"));
  EXPECT_THAT(table.position_nm[0], ElementsAre(10.5, 2000, 0));
  EXPECT_THAT(table.covariance_nm2[0], ElementsAre(16.F, 0.F, 0.F, 9.F, 0.F, ::testing::_));
  SMLM_SHARED_FILE(plain, "formats/locan_rapidSTORM_dstorm_data.txt");
  EXPECT_THAT(read_table(plain, {}).position_nm[1], ElementsAre(16754.9, 18770, 0));
  SMLM_SHARED_FILE(tracks, "formats/locan_rapidSTORM_dstorm_track_data.txt");
  EXPECT_THAT(read_table(tracks, {}).position_nm[1], ElementsAre(2800.64, 2678.95, 0));
  SMLM_SHARED_FILE(images, "formats/locan_rapidSTORM_from_images.txt");
  EXPECT_EQ(read_table(images, {}).size(), 12u);
}

TEST_F(VendorText, SmapCsvHasSites) {
  const LocalisationTable table = read_table(
      write("s_sml.csv",
            "xnm,ynm,znm,locprecnm,locprecznm,phot,sitenumbers\r\n1,2,3,4,5,600,0\r\n1,2,4,4,5,600,17\r\n"),
      {});
  EXPECT_THAT(table.formats, ElementsAre("smap"));
  EXPECT_THAT(table.particle_names, ElementsAre("17"));
  EXPECT_THAT(table.particle, ElementsAre(-1, 0));
  EXPECT_THAT(table.covariance_nm2[0], ElementsAre(16.F, 0.F, 0.F, 16.F, 0.F, 25.F));
  // saveLocalizationsCSV: a blank behind the last name, no axial precision.
  const LocalisationTable other = read_table(
      write("s2.csv", "ID,frame,xnm,ynm,znm,phot,bg,locprecnm \n1,1,1,2,3,600,2,4\n1,1,1,2,5,600,2,4\n"), {});
  EXPECT_TRUE(other.axial_sigma_assumed);
  EXPECT_FLOAT_EQ(other.covariance_nm2[0][0], 16);
}

TEST_F(VendorText, DecodeCsvTakesUnitsFromItsComments) {
  const std::string head =
      "# DECODE EmitterSet\n# {\"version\": \"0.10\"}\n# {\"xy_unit\": \"px\", \"px_size\": [100.0, "
      "200.0]}\n";
  const LocalisationTable table = read_table(
      write("d.csv", head + "x,y,z,phot,frame_ix,id,prob,bg,x_cr,y_cr,z_cr,x_sig,y_sig,z_sig\n"
                            "1,2,30,500,1,1,.9,5,9,9,9,.1,.2,40\n1,2,31,500,1,1,.9,5,9,9,9,.1,.2,40\n"),
      {});
  EXPECT_THAT(table.formats, ElementsAre("decode"));
  EXPECT_THAT(table.position_nm[0], ElementsAre(100, 400, 30));
  EXPECT_FLOAT_EQ(table.covariance_nm2[0][0], 100);
  EXPECT_FLOAT_EQ(table.covariance_nm2[0][3], 1600);
  // Without estimated deviations the Cramer-Rao bounds are used, which are variances.
  const LocalisationTable bounds =
      read_table(write("c.csv", head + "x,y,z,x_cr,y_cr,z_cr\n1,2,30,.01,.04,400\n1,2,31,.01,.04,400\n"), {});
  EXPECT_FLOAT_EQ(bounds.covariance_nm2[0][0], 100);
  EXPECT_FLOAT_EQ(bounds.covariance_nm2[0][5], 400);
  EXPECT_THAT(
      test::error_of([&] { read_table(write("e.csv", "# DECODE EmitterSet\nx,y,z\n1,2,3\n"), {}); }).what(),
      HasSubstr("xy_unit"));
}

}  // namespace
}  // namespace smlm

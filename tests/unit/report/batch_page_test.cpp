#include "polar/report/batch_page.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "smlm/error.hpp"
#include "subject.hpp"

namespace polar::report {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class BatchPage : public ::testing::Test {
 protected:
  BatchPage() {
    std::filesystem::create_directories(directory_.path("first 1"));
    const Results results = pores(6);
    write_result_file(directory_.path("first 1/results.h5"), results, superparticle(results));
    std::ofstream(directory_.path("first 1/report.html")) << "a page";
    write("batch.json", R"({"program": "polar test", "datasets": [
      {"name": "first 1", "condition": "wild & type", "state": "done", "reason": "", "exit_code": 0, "particles": 6,
       "accepted": 3, "localisations": 60, "resolution_nm": null, "rotation_std_deg": 1.5, "symmetry": "C8"},
      {"name": "</script>", "condition": "mutant", "state": "failed", "reason": "there is no table", "exit_code": 3}]})");
    write("conditions.csv",
          "measure,condition,minus,datasets,minus_datasets,mean,low,high\n"
          "accepted_share,wild & type,,1,,0.5,0.4,0.6\n"
          "accepted_share,wild & type,mutant,1,1,0.25,-0.1,0.6\n");
  }
  void write(const std::string& name, const std::string& text) {
    std::ofstream(directory_.path(name)) << text;
  }
  support::TemporaryDirectory directory_;
};

TEST_F(BatchPage, ReadsRowsMeansAndThumbnails) {
  const BatchRecord b = read_batch_record(directory_.path());
  ASSERT_EQ(b.datasets.size(), 2u);
  EXPECT_EQ(b.datasets[0].link, "./first%201/report.html");
  EXPECT_EQ(b.datasets[0].thumbnail_png.substr(1, 3), "PNG");
  EXPECT_EQ(b.datasets[0].number.count("resolution_nm"), 0u);
  EXPECT_EQ(b.datasets[0].number.count("exit_code"), 0u);
  EXPECT_EQ(b.datasets[1].link + b.datasets[1].thumbnail_png, "");
  ASSERT_EQ(b.means.size(), 2u);
  EXPECT_EQ(b.means[1].minus, "mutant");
}

TEST_F(BatchPage, HasAStripForEveryNumberAndSaysWhichIsMissing) {
  const std::string page = batch_page(read_batch_record(directory_.path()), "pores");
  EXPECT_THAT(page, HasSubstr("id=\"strip-accepted_share\" data-figure=\"present\""));
  EXPECT_THAT(page, HasSubstr("id=\"strip-resolution_nm\" data-figure=\"absent\""));
  EXPECT_THAT(page, HasSubstr("wild &amp; type"));
  EXPECT_THAT(page, HasSubstr("2 data sets: 1 done, 1 failed."));
  EXPECT_THAT(page, HasSubstr("<li>&lt;/script&gt; failed: there is no table</li>"));
  EXPECT_THAT(page, Not(HasSubstr("\"</script>")));
  EXPECT_THAT(page, HasSubstr("-0.1000"));  // of the differences
}

TEST_F(BatchPage, RefusesWhatIsNoBatch) {
  write("batch.json", "{\"datasets\": 3}");
  EXPECT_THROW(read_batch_record(directory_.path()), smlm::Error);
  write("batch.json", "{");
  EXPECT_THROW(read_batch_record(directory_.path()), smlm::Error);
}

TEST_F(BatchPage, ADataSetThatIsBeingWrittenHasNoThumbnailYet) {
  write("first 1/results.h5", "half a file");
  EXPECT_EQ(read_batch_record(directory_.path()).datasets[0].thumbnail_png, "");
}

}  // namespace
}  // namespace polar::report

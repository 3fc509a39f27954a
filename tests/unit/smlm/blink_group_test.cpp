#include "smlm/blink_group.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <random>

#include "fixture.hpp"
#include "smlm/table_reader.hpp"

namespace smlm {
namespace {

using test::error_of;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class BlinkGroup : public test::TemporaryFolder {
 protected:
  // x, sigma, frame, particle
  struct Row {
    double x, sigma;
    int frame, particle;
  };
  LocalisationTable merged(const std::vector<Row>& rows, const std::string& distance, int dark_frames = 1) {
    std::string text = "x [nm],y [nm],z [nm],sigma_xy [nm],sigma_z [nm],photons,frame,score,particle\n";
    for (const Row& r : rows)
      text += std::to_string(r.x) + ",0,0," + std::to_string(r.sigma) + "," + std::to_string(2 * r.sigma) +
              ",100," + std::to_string(r.frame) + "," + std::to_string(r.x) + "," +
              std::to_string(r.particle) + "\n";
    ReadOptions options;
    options.group = {distance, dark_frames};
    return read_table(write("t.csv", text), options);
  }
  static std::vector<double> column(const LocalisationTable& t, const std::string& name) {
    for (const ExtraColumn& c : t.extra)
      if (c.name == name) return c.values;
    return {};
  }
};

TEST_F(BlinkGroup, WeighsByInverseVarianceAndSumsPhotons) {
  const LocalisationTable t = merged({{0, 1, 5, 1}, {3, 2, 6, 1}}, "5 nm");
  ASSERT_EQ(t.size(), 1u);
  EXPECT_NEAR(t.position_nm[0][0], (0 / 1.0 + 3 / 4.0) / (1 + 0.25), 1e-9);
  EXPECT_NEAR(t.covariance_nm2[0][0], 1 / 1.25, 1e-6);
  EXPECT_NEAR(t.covariance_nm2[0][5], 4 / 1.25, 1e-6);
  EXPECT_THAT(column(t, "photons"), ElementsAre(200));
  EXPECT_THAT(column(t, "frame"), ElementsAre(5));
  EXPECT_THAT(column(t, "score"), ElementsAre(1.5));
  EXPECT_THAT(column(t, "merged"), ElementsAre(2));
}

TEST_F(BlinkGroup, FollowsAMoleculeOverDarkFramesAndNoFurther) {
  const std::vector<Row> rows = {{0, 1, 1, 1}, {0, 1, 3, 1}, {0, 1, 6, 1}};
  EXPECT_EQ(merged(rows, "5 nm", 0).size(), 3u);
  EXPECT_EQ(merged(rows, "5 nm", 1).size(), 2u);
  EXPECT_EQ(merged(rows, "5 nm", 2).size(), 1u);
}

TEST_F(BlinkGroup, NeverMergesWithinAFrameNorAcrossParticles) {
  EXPECT_EQ(merged({{0, 1, 1, 1}, {0, 1, 1, 1}}, "5 nm").size(), 2u);
  EXPECT_EQ(merged({{0, 1, 1, 1}, {0, 1, 2, 2}}, "5 nm").size(), 2u);
}

TEST_F(BlinkGroup, StepsFromTheLatestLocalisation) {
  // The third is out of the first one's reach, but not out of the second one's.
  EXPECT_EQ(merged({{0, 1, 1, 1}, {4, 1, 2, 1}, {8, 1, 3, 1}}, "5 nm").size(), 1u);
}

TEST_F(BlinkGroup, TakesTheFirstRowOfTheNextFrame) {
  const LocalisationTable t = merged({{0, 1, 1, 1}, {4, 1, 2, 1}, {1, 1, 2, 1}}, "5 nm");
  EXPECT_THAT(column(t, "score"), ElementsAre(2, 1));
}

TEST_F(BlinkGroup, SigmasAreThoseOfBothTogether) {
  const std::vector<Row> rows = {{0, 3, 1, 1}, {9.9, 4, 2, 1}};
  EXPECT_EQ(merged(rows, "2 sigma").size(), 1u);    // 2 x 5 nm
  EXPECT_EQ(merged(rows, "1.9 sigma").size(), 2u);  // 9.5 nm
}

TEST_F(BlinkGroup, WithoutFramesOrWithABadDistanceItSaysSo) {
  ReadOptions options;
  options.group.distance = "5 nm";
  const std::string file = write("n.csv", "x,y,sigma_xy,particle\n1,2,3,1\n1,2,3,1\n");
  EXPECT_THAT(error_of([&] { read_table(file, options); }).what(), HasSubstr("has no frames"));
  for (const char* wrong : {"5", "nm", "-1 nm", "5 um", "5 nm x", "1e9 nm"})
    EXPECT_EQ(violations(BlinkOptions{wrong, 1}).size(), 1u) << wrong;
  EXPECT_EQ(violations(BlinkOptions{"5 nm", -1}).size(), 1u);
}

// A crowded field: uncertainties differ by row and axis, chains compete, particles interleave. The rule
// again, slow and written out: every row against every other.
class Crowd : public BlinkGroup {
 protected:
  struct Blink {
    std::array<double, 3> x, sigma;
    int frame, particle;
  };
  std::vector<Blink> blink_;

  void draw(int rows) {
    std::mt19937 random(5);
    const auto uniform = [&](double low, double high) {
      return low + (high - low) * static_cast<double>(random()) / 4294967296.0;
    };
    for (int i = 0; i < rows; ++i)
      blink_.push_back({{uniform(0, 120), uniform(0, 120), uniform(0, 120)},
                        {uniform(1, 9), uniform(1, 9), uniform(2, 25)},
                        static_cast<int>(random() % 40),
                        static_cast<int>(random() % 3)});
  }
  LocalisationTable merge(double sigmas, int dark_frames) {
    std::string text = "x [nm],y [nm],z [nm],sigma_x [nm],sigma_y [nm],sigma_z [nm],photons,frame,particle\n";
    for (const Blink& b : blink_) {
      for (const double v : b.x) text += std::to_string(v) + ",";
      for (const double v : b.sigma) text += std::to_string(v) + ",";
      text += "100," + std::to_string(b.frame) + "," + std::to_string(b.particle) + "\n";
    }
    ReadOptions options;
    options.group = {std::to_string(sigmas) + " sigma", dark_frames};
    return read_table(write("crowd.csv", text), options);
  }
  bool same_molecule(const Blink& a, const Blink& b, double sigmas) const {
    const double lateral = (a.sigma[0] * a.sigma[0] + a.sigma[1] * a.sigma[1]) / 2 +
                           (b.sigma[0] * b.sigma[0] + b.sigma[1] * b.sigma[1]) / 2;
    const double axial = a.sigma[2] * a.sigma[2] + b.sigma[2] * b.sigma[2];
    return a.particle == b.particle &&
           std::hypot(a.x[0] - b.x[0], a.x[1] - b.x[1]) <= sigmas * std::sqrt(lateral) &&
           std::abs(a.x[2] - b.x[2]) <= sigmas * std::sqrt(axial);
  }
  std::vector<std::vector<std::size_t>> chains(double sigmas, int dark_frames) const {
    std::vector<bool> taken(blink_.size(), false);
    std::vector<std::vector<std::size_t>> all;
    for (int frame = 0; frame < 40; ++frame)
      for (std::size_t start = 0; start < blink_.size(); ++start) {
        if (taken[start] || blink_[start].frame != frame) continue;
        all.push_back({});
        for (std::size_t here = start; here < blink_.size();) {
          all.back().push_back(here);
          taken[here] = true;
          std::size_t next = blink_.size();
          for (int later = 1; later <= dark_frames + 1 && next == blink_.size(); ++later)
            for (std::size_t i = blink_.size(); i-- > 0;)
              if (!taken[i] && blink_[i].frame == blink_[here].frame + later &&
                  same_molecule(blink_[here], blink_[i], sigmas))
                next = i;
          here = next;
        }
      }
    return all;
  }
};

TEST_F(Crowd, SigmasMergeWhatTheRuleWrittenOutDoes) {
  draw(1500);
  for (const auto& [sigmas, dark_frames] : {std::pair{2.0, 1}, {2.0, 0}, {1.3, 3}}) {
    const LocalisationTable t = merge(sigmas, dark_frames);
    const auto expected = chains(sigmas, dark_frames);
    ASSERT_EQ(t.size(), expected.size());
    EXPECT_LT(t.size(), 1300u) << "hardly anything was merged";
    const std::vector<double> photons = column(t, "photons"), merged = column(t, "merged");
    for (std::size_t k = 0; k < t.size(); ++k) {
      ASSERT_EQ(t.source_row[k], expected[k].front() + 1);
      ASSERT_EQ(merged[k], static_cast<double>(expected[k].size()));
      EXPECT_EQ(photons[k], 100 * merged[k]);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        double weight = 0, sum = 0;
        for (const std::size_t i : expected[k]) {
          const double w = 1 / (blink_[i].sigma[axis] * blink_[i].sigma[axis]);
          weight += w, sum += w * blink_[i].x[axis];
        }
        EXPECT_NEAR(t.position_nm[k][axis], sum / weight, 1e-4);  // six decimals in, float variances
      }
    }
  }
}

// A thousand molecules far apart, each on for some frames in a row: one localisation each comes out.
TEST_F(BlinkGroup, EveryMoleculeBecomesOne) {
  std::vector<Row> rows;
  for (int frame = 0; frame < 6; ++frame)
    for (int molecule = 0; molecule < 1000; ++molecule)
      if (frame >= molecule % 3 && frame <= molecule % 3 + molecule % 4)
        rows.push_back({100.0 * molecule + frame % 2, 2, frame, molecule % 7});
  const LocalisationTable t = merged(rows, "2 sigma", 0);
  EXPECT_EQ(t.size(), 1000u);
  double total = 0;
  for (const double n : column(t, "merged")) total += n;
  EXPECT_EQ(total, static_cast<double>(rows.size()));
}

}  // namespace
}  // namespace smlm

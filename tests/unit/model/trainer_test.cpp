#include "polar/model/trainer.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <mutex>
#include <set>
#include <thread>

#include "model/network_step.hpp"
#include "model/training_cloud.hpp"
#include "model/warm_start.hpp"
#include "polar/core/parallel.hpp"
#include "polar/model/chamfer.hpp"
#include "polar/model/score.hpp"
#include "polar/model/weights_file.hpp"
#include "smlm/error.hpp"

namespace polar {
namespace {

class Quiet : public Progress {};

/// Stops before step `last` + 1.
class StopAfter : public Progress {
 public:
  explicit StopAfter(int last) : last_(last) {}
  void step(const std::string&, int done, int) override { done_ = done; }
  bool cancelled() const override { return done_ >= last_; }

 private:
  int last_, done_ = 0;
};

/// Distinct threads that share a loop whose bodies last long enough for all to arrive.
std::size_t threads_taking_part() {
  std::mutex guard;
  std::set<std::thread::id> ids;
  parallel_for(200, [&](std::size_t) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    const std::lock_guard<std::mutex> lock(guard);
    ids.insert(std::this_thread::get_id());
  });
  return ids.size();
}

class TrainerTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              (std::string("polar_train_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
    options_.steps = 4;
    options_.clouds_per_step = 6;
    options_.report_every_steps = 2;
    options_.degradation.max_points = 200;
    options_.weights = (folder_ / "weights.h5").string();
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  TrainOptions options_;
  std::filesystem::path folder_;
  Quiet quiet_;
};

TEST_F(TrainerTest, sameBitsForAnyNumberOfThreads) {
  std::set<std::string> hashes;
  for (const int threads : {1, 2, 8}) {
    const ThreadLimit limit(threads);
    const int expected = std::min(threads, static_cast<int>(std::thread::hardware_concurrency()));
    ASSERT_EQ(threads_taking_part(), static_cast<std::size_t>(expected));
    hashes.insert(train(options_, quiet_).weights_sha256);
  }
  EXPECT_EQ(hashes.size(), 1u);
  EXPECT_EQ(hashes.begin()->size(), 64u);
  options_.seed = 2;
  hashes.insert(train(options_, quiet_).weights_sha256);
  EXPECT_EQ(hashes.size(), 2u);
}

TEST_F(TrainerTest, goesOnFromItsCheckpointWithTheSameBits) {
  const TrainReport whole = train(options_, quiet_);
  ASSERT_EQ(whole.stopped_because, "all steps done");
  options_.checkpoint = (folder_ / "checkpoint.h5").string();
  for (const int last : {1, 3}) {  // 3: between two reports
    StopAfter stop(last);
    const TrainReport part = train(options_, stop);
    EXPECT_EQ(part.stopped_because, "it was interrupted");
    EXPECT_EQ(part.steps_done, last);
    EXPECT_EQ(part.weights_sha256, "");
  }
  const TrainReport rest = train(options_, quiet_);
  EXPECT_EQ(rest.weights_sha256, whole.weights_sha256);
  EXPECT_EQ(rest.step, whole.step);
  EXPECT_EQ(rest.loss, whole.loss);
  options_.seed = 9;
  EXPECT_THROW(train(options_, quiet_), smlm::Error);
}

TEST_F(TrainerTest, reportsTheMeanLossWhenTheIntervalChangesOnTheWay) {
  options_.report_every_steps = 1;
  const TrainReport each = train(options_, quiet_);
  ASSERT_EQ(each.loss.size(), 4u);
  options_.checkpoint = (folder_ / "checkpoint.h5").string();
  options_.report_every_steps = 4;
  StopAfter stop(1);
  train(options_, stop);
  options_.report_every_steps = 2;
  const TrainReport report = train(options_, quiet_);
  ASSERT_EQ(report.step, (std::vector<std::int64_t>{2, 4}));
  EXPECT_NEAR(report.loss[0], (each.loss[0] + each.loss[1]) / 2, 1e-12);
  EXPECT_NEAR(report.loss[1], (each.loss[2] + each.loss[3]) / 2, 1e-12);
}

TEST_F(TrainerTest, learnsToRestoreCloudsItNeverSaw) {
  options_.steps = 200;
  options_.clouds_per_step = 16;
  options_.report_every_steps = 20;
  options_.warmup_steps = 20;
  options_.batch_norm_momentum = 0.1;
  options_.degradation.max_points = 128;
  options_.degradation.clean_share = 1;
  options_.degradation.cut_share = 0;
  const TrainReport report = train(options_, quiet_);
  ASSERT_EQ(report.loss.size(), 10u);
  EXPECT_LT(report.loss.back(), report.loss.front());
  EXPECT_GT(report.clouds_per_second, 0);
  const WeightsFile file = read_weights(options_.weights);
  EXPECT_EQ(file.sha256, report.weights_sha256);
  const auto model = make_pointnet(file.weights);
  constexpr std::uint64_t kClouds = 64;
  double restored = 0, unrelated = 0;  // what an answer that ignores its input reaches
  Eigen::Matrix3Xf previous = training_cloud(77, kClouds, options_.data, {}, options_.degradation).target;
  for (std::uint64_t item = 0; item < kClouds; ++item) {
    const TrainingCloud cloud = training_cloud(77, item, options_.data, {}, options_.degradation);
    restored += chamfer(model->decode(model->encode(cloud.input).latent), cloud.target).sum() / kClouds;
    unrelated += chamfer(previous, cloud.target).sum() / kClouds;
    previous = cloud.target;
  }
  EXPECT_LT(restored, 0.7 * unrelated) << restored << " against " << unrelated;
  // Inference on the folded weights does what training saw.
  EXPECT_NEAR(restored, report.loss.back(), 0.15 * report.loss.back());
}

TEST_F(TrainerTest, startsFromFinishedWeights) {
  options_.steps = 60;
  options_.clouds_per_step = 16;
  options_.warmup_steps = 5;
  options_.batch_norm_momentum = 0.1;
  const TrainReport first = train(options_, quiet_);
  const PointNetWeights finished = read_weights(options_.weights).weights;
  std::vector<TrainingCloud> batch;
  for (std::uint64_t i = 0; i < 256; ++i)
    batch.push_back(training_cloud(5, i, options_.data, {}, options_.degradation));
  TrainState state = initial_state(options_);
  start_from(finished, batch, state);
  // The same function at inference, and with the norms of the batch.
  const PointNetWeights again = folded(state.parameters, state.moments);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_TRUE(again.encoder[i].weight.isApprox(finished.encoder[i].weight, 1e-5f)) << i;
    EXPECT_TRUE(again.encoder[i].bias.isApprox(finished.encoder[i].bias, 1e-4f)) << i;
    EXPECT_TRUE(again.decoder[i].weight.isApprox(finished.decoder[i].weight, 1e-5f)) << i;
    EXPECT_TRUE(again.decoder[i].bias.isApprox(finished.decoder[i].bias, 1e-4f)) << i;
  }
  const auto model = make_pointnet(finished);
  double inference = 0;
  for (const TrainingCloud& cloud : batch)
    inference += chamfer(model->decode(model->encode(cloud.input).latent), cloud.target).sum() /
                 static_cast<double>(batch.size());
  std::vector<float> gradient;
  EXPECT_NEAR(NetworkStep().loss(state.parameters, batch, {}, gradient), inference, 0.01 * inference);
  // And a training that starts there is where the first one ended, not where it began.
  options_.initial_weights = options_.weights;
  options_.weights = (folder_ / "finer.h5").string();
  options_.steps = 2;
  options_.learning_rate = 1e-5;
  EXPECT_LT(train(options_, quiet_).loss.front(), 0.5 * (first.loss.front() + first.loss.back()));
}

TEST_F(TrainerTest, namesEveryFaultOfItsOptions) {
  options_.steps = 0;
  options_.degradation.min_visibility = 1.5;
  options_.schedule = "linear";
  EXPECT_EQ(violations(options_).size(), 3u);
  EXPECT_THROW(train(options_, quiet_), smlm::Error);
  options_.degradation.max_sigma = std::nan("");
  EXPECT_EQ(violations(options_).size(), 4u);
}

TEST(TrainingCloud, gridsOfSitesAreFlat) {
  TrainData data;
  data.sites_share = data.grid_share = 1;
  Degradation clean;
  clean.clean_share = 1;
  for (std::uint64_t item = 0; item < 50; ++item) {
    const Eigen::Matrix3Xf cloud = training_cloud(1, item, data, {}, clean).target;
    const Eigen::Matrix3Xf centred = cloud.colwise() - cloud.rowwise().mean();
    const Eigen::Vector3f spread =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f>(centred * centred.transpose()).eigenvalues();
    ASSERT_LT(std::sqrt(spread[0]), 0.5 * std::sqrt(spread[2])) << item;
  }
}

TEST(TrainingCloud, keepsItsPromises) {
  const Degradation d;
  int smallest = 2000, cut = 0;
  for (std::uint64_t item = 0; item < 300; ++item) {
    const TrainingCloud cloud = training_cloud(1, item, {}, {}, d);
    ASSERT_EQ(cloud.target.cols(), 1024);
    ASSERT_GE(cloud.input.cols(), d.min_points);
    ASSERT_LE(cloud.input.cols(), d.max_points);
    ASSERT_TRUE(cloud.input.allFinite() && cloud.target.allFinite());
    const float radius = std::sqrt(
        (cloud.target.colwise() - cloud.target.rowwise().mean()).colwise().squaredNorm().maxCoeff());
    ASSERT_LE(radius, 1.0001f);
    ASSERT_GE(radius, 0.6999f);
    smallest = std::min(smallest, static_cast<int>(cloud.input.cols()));
    cut += cloud.input.cols() < 1024 && cloud.input.cols() > 716 ? 1 : 0;
  }
  EXPECT_LT(smallest, 60);
  EXPECT_GT(cut, 30);
  Degradation blinking = d;
  blinking.few_labels_share = 1, blinking.clean_share = 1, blinking.max_labels = 30;
  for (std::uint64_t item = 0; item < 50; ++item) {
    const TrainingCloud cloud = training_cloud(1, item, {}, {}, blinking);
    std::set<std::array<float, 3>> labels;
    for (const auto& p : cloud.input.colwise()) labels.insert({p.x(), p.y(), p.z()});
    ASSERT_LE(labels.size(), 30u);
    ASSERT_GE(labels.size(), 8u);
    ASSERT_GE(cloud.input.cols(), d.min_points);
  }
  const TrainingCloud once = training_cloud(1, 5, {}, {}, d), again = training_cloud(1, 5, {}, {}, d);
  EXPECT_EQ(once.input, again.input);
  EXPECT_NE(training_cloud(1, 6, {}, {}, d).target, once.target);
}

}  // namespace
}  // namespace polar

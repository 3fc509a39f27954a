#include "polar/pipeline/batch.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "pipeline/config/node.hpp"
#include "polar/pipeline/simulate_run.hpp"
#include "smlm/error.hpp"
#include "support/stand_in_engine.hpp"
#include "support/temporary_directory.hpp"

namespace polar {
namespace {

using support::stay;
using ::testing::HasSubstr;

class Cancelling : public Progress {
 public:
  bool cancelled() const override { return true; }
};

class CancelledOnceBegun : public Progress {
 public:
  void note(const std::string&) override { begun_ = true; }
  bool cancelled() const override { return begun_; }

 private:
  bool begun_ = false;
};

class BatchTest : public ::testing::Test {
 protected:
  BatchTest() {
    SimulateConfig simulation;
    simulation.simulation.particles = 4;
    simulation.simulation.orientation = "identity";
    simulation.simulation.cramer_rao = false;
    for (const char* folder : {"data/wild/1", "data/wild/2", "data/mutant/1"}) {
      simulation.directory = directory_.path(folder);
      run_simulation(simulation, false);
      ++simulation.simulation.seed;
    }
  }
  static constexpr const char* kFolders = "datasets: {folders: data/*/*, input: localisations.csv}\n";

  BatchConfig load(const std::string& text, const std::vector<std::string>& overrides = {}) {
    std::ofstream(directory_.path("batch.yaml")) << text;
    return load_batch_config(directory_.path("batch.yaml"), overrides);
  }
  void expect_fault(const std::string& text, const std::string& part) {
    try {
      load(text);
      ADD_FAILURE() << "accepted: " << text;
    } catch (const smlm::Error& e) {
      EXPECT_EQ(e.exit_code(), 2) << e.what();
      EXPECT_THAT(e.what(), HasSubstr(part));
    }
  }
  BatchOutcome run(const std::string& text, const BatchFlags& flags = {}, const Engine& engine = stay) {
    return run_batch(load(text), flags, progress_, engine);
  }
  nlohmann::json state() {
    std::ifstream in(directory_.path("batch/batch.json"));
    return nlohmann::json::parse(in);
  }
  std::vector<std::string> states() {
    std::vector<std::string> all;
    const nlohmann::json batch = state();
    for (const auto& d : batch["datasets"])
      all.push_back(d["name"].get<std::string>() + " " + d["state"].get<std::string>());
    return all;
  }
  std::string content(const std::string& name) {
    std::ifstream in(directory_.path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  support::TemporaryDirectory directory_;
  Progress progress_;
};

TEST_F(BatchTest, DefaultsOverridesAndTheCommandLineMakeARun) {
  const BatchConfig c = load(
      "defaults: {registration: {seed: 2, search: exhaustive}, output: {formats: [csv]}}\n"
      "datasets:\n"
      "  - {name: a, condition: wild, input: data/wild/*/localisations.csv}\n"
      "  - {name: b, input: [data/mutant/1/localisations.csv], overrides: {registration: {seed: 3}}}\n",
      {"output.preview=false"});
  ASSERT_EQ(c.datasets.size(), 2u);
  EXPECT_EQ(c.datasets[0].run.files.size(), 2u);
  EXPECT_EQ(c.datasets[0].run.registration.seed, 2u);
  EXPECT_EQ(c.datasets[1].run.registration.seed, 3u);
  EXPECT_EQ(c.datasets[1].run.registration.search, "exhaustive");
  EXPECT_EQ(c.datasets[1].run.output.formats, std::vector<std::string>{"csv"});
  EXPECT_FALSE(c.datasets[1].run.output.preview);
  EXPECT_EQ(c.datasets[1].run.output.directory, directory_.path("batch/b"));
}

TEST_F(BatchTest, APatternMakesADataSetOfEveryFolder) {
  const BatchConfig c = load(kFolders);
  ASSERT_EQ(c.datasets.size(), 3u);
  EXPECT_EQ(c.datasets[0].name, "mutant_1");
  EXPECT_EQ(c.datasets[0].condition, "mutant");
  EXPECT_EQ(c.datasets[2].name, "wild_2");
  EXPECT_EQ(c.datasets[2].run.files,
            std::vector<std::string>{directory_.path("data/wild/2/localisations.csv")});
}

TEST_F(BatchTest, FaultsOfTheConfigurationAreFoundBeforeAnythingRuns) {
  expect_fault("{}\n", "datasets is missing");
  expect_fault("datasets: [{name: a, inptu: x}]\n", "did you mean 'datasets[1].input'?");
  expect_fault("datasets: [{name: a}]\n", "datasets[1].input is missing");
  expect_fault("datasets: [{input: x}]\n", "either name");
  expect_fault("datasets: [{name: a, folders: b, input: x}]\n", "either name");
  expect_fault("datasets: [{name: a/b, input: x}]\n", "expected the name of a folder");
  expect_fault("datasets: [{name: .., input: x}]\n", "expected the name of a folder");
  expect_fault("datasets: [{name: summary.csv, input: x}]\n", "expected the name of a folder");
  expect_fault("datasets: [{name: report.html, input: x}]\n", "expected the name of a folder");
  expect_fault("datasets: [{name: a, input: x}, {name: a, input: y}]\n", "two data sets are called 'a'");
  expect_fault("datasets: [{folders: nowhere/*, input: x}]\n", "no folder matches");
  expect_fault("defaults: {registration: {sede: 2}}\ndatasets: [{name: a, input: x}]\n",
               "batch.yaml:1: unknown key 'registration.sede'");
  expect_fault("datasets:\n - {name: a, input: x, overrides: {output: {directory: y}}}\n",
               "batch.yaml:2: overrides holds output.directory");
  expect_fault("defaults: {input: {files: x}}\ndatasets: [{name: a, input: x}]\n",
               "defaults holds input.files");
  expect_fault("defaults: 3\ndatasets: [{name: a, input: x}]\n", "expected a section");
  expect_fault("datasets: 3\n", "expected a list");
  expect_fault(std::string(kFolders) + "bootstrap: {draws: 1, level: 2}\n", "bootstrap.draws must be");
}

TEST_F(BatchTest, TheExampleNamesEveryKeyWithItsDefault) {
  pipeline::Node shipped = pipeline::load_yaml(POLAR_SOURCE_DIR "/configs/batch.yaml");
  const BatchConfig defaults;
  pipeline::Node* bootstrap = shipped.find("bootstrap");
  ASSERT_NE(bootstrap, nullptr);
  EXPECT_EQ(bootstrap->find("draws")->scalar, std::to_string(defaults.bootstrap.draws));
  EXPECT_EQ(std::stod(bootstrap->find("level")->scalar), defaults.bootstrap.level);
  EXPECT_EQ(bootstrap->find("seed")->scalar, std::to_string(defaults.bootstrap.seed));
  EXPECT_EQ(shipped.find("output")->find("directory")->scalar, defaults.directory);
  // Its keys are all known: what is refused is only that the folders of the example are not there.
  try {
    load_batch_config(POLAR_SOURCE_DIR "/configs/batch.yaml", {});
    ADD_FAILURE() << "the example's data are there";
  } catch (const smlm::Error& e) {
    EXPECT_THAT(e.what(), HasSubstr("no folder matches"));
  }
}

TEST_F(BatchTest, WritesWhatARunWritesAndTheTables) {
  const BatchOutcome o = run(kFolders, {{}, 2, 2, false});
  EXPECT_FALSE(o.some_failed);
  EXPECT_THAT(states(), ::testing::ElementsAre("mutant_1 done", "wild_1 done", "wild_2 done"));
  for (const char* name : {"poses.csv", "results.h5", "summary.json"})
    EXPECT_TRUE(std::filesystem::exists(directory_.path("batch/wild_2/") + name)) << name;
  const std::string summary = content("batch/summary.csv");
  EXPECT_THAT(summary, ::testing::StartsWith("name,condition,particles,accepted,localisations,"));
  EXPECT_THAT(summary, HasSubstr("\nmutant_1,mutant,4,4,"));
  EXPECT_THAT(content("batch/conditions.csv"), HasSubstr("\naccepted_share,wild,,2,,1,1,1\n"));
  EXPECT_THAT(content("batch/conditions.csv"), HasSubstr("\naccepted_share,wild,mutant,2,1,0,,\n"));
  EXPECT_EQ(state()["bootstrap"]["draws"], 10000);
  EXPECT_THAT(content("batch/report.html"), HasSubstr("./wild_2/report.html"));
}

TEST_F(BatchTest, OneThatFailsStopsNoOther) {
  std::ofstream(directory_.path("data/wild/1/localisations.csv")) << "nonsense\n";
  std::filesystem::remove(directory_.path("data/mutant/1/localisations.csv"));
  const Engine crashes = [this](const Views& v, const RegistrationOptions& o, Progress& p, Checkpoint& c) {
    if (v.view.size() == 3) std::raise(SIGABRT);
    return stay(v, o, p, c);
  };
  SimulateConfig three;
  three.simulation.particles = 3;
  three.directory = directory_.path("data/wild/3");
  run_simulation(three, false);
  const BatchOutcome o = run(kFolders, {}, crashes);
  EXPECT_TRUE(o.some_failed);
  EXPECT_FALSE(o.cancelled);
  EXPECT_THAT(states(),
              ::testing::ElementsAre("mutant_1 failed", "wild_1 failed", "wild_2 done", "wild_3 failed"));
  const nlohmann::json datasets = state()["datasets"];
  EXPECT_EQ(datasets[0]["exit_code"], 3);
  EXPECT_THAT(datasets[0]["reason"], HasSubstr("no such file"));
  EXPECT_EQ(datasets[1]["exit_code"], 3);
  EXPECT_EQ(datasets[3]["exit_code"], 128 + SIGABRT);
  EXPECT_THAT(datasets[3]["reason"], HasSubstr("it crashed"));
}

TEST_F(BatchTest, KeepsWhatIsCompleteAndRunsWhatChanged) {
  run(kFolders);
  const Engine must_not_run = [](const Views&, const RegistrationOptions&, Progress&,
                                 Checkpoint&) -> Registration { throw std::logic_error("computed again"); };
  EXPECT_FALSE(run(kFolders, {}, must_not_run).some_failed);
  EXPECT_THAT(states(), ::testing::ElementsAre("mutant_1 kept", "wild_1 kept", "wild_2 kept"));
  EXPECT_THAT(content("batch/summary.csv"), HasSubstr("\nmutant_1,mutant,4,4,"));
  std::ofstream(directory_.path("data/wild/2/localisations.csv"), std::ios::app) << "1,1,1,1,1,1,1,1,1,1\n";
  EXPECT_TRUE(run(kFolders).some_failed);
  EXPECT_THAT(state()["datasets"][2]["reason"], HasSubstr("another input"));
  EXPECT_FALSE(run(kFolders, {{}, 1, 0, true}).some_failed);
  EXPECT_THAT(states(), ::testing::ElementsAre("mutant_1 kept", "wild_1 kept", "wild_2 done"));
}

TEST_F(BatchTest, OnlyTheNamedOnesRun) {
  run(kFolders, {{"wild_1"}, 1, 0, false});
  EXPECT_THAT(states(), ::testing::ElementsAre("mutant_1 waiting", "wild_1 done", "wild_2 waiting"));
  try {
    run(kFolders, {{"wild_11"}, 1, 0, false});
    ADD_FAILURE();
  } catch (const smlm::Error& e) {
    EXPECT_EQ(e.exit_code(), 2);
    EXPECT_THAT(e.what(), HasSubstr("did you mean 'wild_1'?"));
  }
}

BatchFlags part(BatchPart of, const std::vector<std::string>& only = {}) {
  BatchFlags flags;
  flags.part = of;
  flags.only = only;
  return flags;
}

TEST_F(BatchTest, InPartsItComesToTheSame) {
  std::ofstream(directory_.path("data/wild/1/localisations.csv")) << "nonsense\n";
  EXPECT_TRUE(run(kFolders).some_failed);
  nlohmann::json whole = state();
  std::filesystem::remove_all(directory_.path("batch"));
  for (const char* name : {"wild_2", "mutant_1", "wild_1"})
    EXPECT_EQ(run(kFolders, part(BatchPart::data_sets, {name})).some_failed, name == std::string("wild_1"));
  EXPECT_FALSE(std::filesystem::exists(directory_.path("batch/summary.csv")));
  EXPECT_TRUE(run(kFolders, part(BatchPart::tables)).some_failed);
  nlohmann::json gathered = state();
  for (nlohmann::json* j : {&whole, &gathered})
    for (auto& d : (*j)["datasets"]) d.erase("seconds");
  EXPECT_EQ(gathered, whole);
  EXPECT_THAT(content("batch/report.html"), HasSubstr("./wild_2/report.html"));
  // Those that were not named have been there before.
  EXPECT_FALSE(run(kFolders, part(BatchPart::tables, {"wild_2"})).some_failed);
  EXPECT_THAT(states(), ::testing::ElementsAre("mutant_1 kept", "wild_1 waiting", "wild_2 done"));
}

TEST_F(BatchTest, APartThatWasStoppedOrLeftNoWordIsSaid) {
  CancelledOnceBegun cancelled;
  const auto before = std::signal(SIGTERM, SIG_IGN);  // which the program hears by a handler of its own
  EXPECT_TRUE(run_batch(load(kFolders), part(BatchPart::data_sets, {"wild_1"}), cancelled, stay).cancelled);
  std::signal(SIGTERM, before);
  const BatchOutcome o = run(kFolders, part(BatchPart::tables));
  EXPECT_TRUE(o.some_failed);
  EXPECT_THAT(states(), ::testing::ElementsAre("mutant_1 failed", "wild_1 stopped", "wild_2 failed"));
  EXPECT_THAT(o.summary[1], HasSubstr("mutant_1: it left no word of its end"));
  EXPECT_THAT(o.summary[2], HasSubstr("wild_1: out of its time"));
  run(kFolders, part(BatchPart::data_sets, {"wild_1"}));
  EXPECT_FALSE(run(kFolders, part(BatchPart::tables, {"wild_1"})).some_failed);
}

TEST_F(BatchTest, CancelledStartsNothingMore) {
  Cancelling cancelling;
  EXPECT_TRUE(run_batch(load(kFolders), {}, cancelling, stay).cancelled);
  EXPECT_THAT(states(), ::testing::Each(HasSubstr("waiting")));
}

TEST_F(BatchTest, AnOutputThatIsAFileIsRefusedFirst) {
  std::ofstream(directory_.path("batch")) << "mine";
  try {
    run(kFolders);
    ADD_FAILURE();
  } catch (const smlm::Error& e) {
    EXPECT_EQ(e.exit_code(), 4);
  }
  EXPECT_EQ(content("batch"), "mine");
}

}  // namespace
}  // namespace polar

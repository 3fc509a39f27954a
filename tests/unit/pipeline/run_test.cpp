#include "polar/pipeline/run.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "polar/core/sha256.hpp"
#include "polar/pipeline/simulate_run.hpp"
#include "polar/results/compare.hpp"
#include "polar/results/pose_table.hpp"
#include "smlm/error.hpp"
#include "smlm/h5/file.hpp"
#include "support/stand_in_engine.hpp"
#include "support/temporary_directory.hpp"

namespace polar {
namespace {

using ::testing::HasSubstr;

using support::stay;

class Cancelling : public Progress {
 public:
  bool cancelled() const override { return true; }
};

class Run : public ::testing::Test {
 protected:
  Run() {
    SimulateConfig simulation;
    simulation.simulation.particles = 4;
    simulation.simulation.orientation = "identity";
    simulation.simulation.cramer_rao = false;
    simulation.directory = directory_.path("data");
    run_simulation(simulation, false);
    write_config("input:\n  files: data/localisations.csv\n");
  }
  void write_config(const std::string& text) { std::ofstream(directory_.path("run.yaml")) << text; }
  RunConfig config() { return load_run_config(directory_.path("run.yaml"), {}); }
  std::string out(const std::string& name = {}) {
    return directory_.path("results") + (name.empty() ? "" : "/" + name);
  }
  int fault(const RunFlags& flags, const Engine& engine = stay) {
    try {
      run(config(), flags, progress_, engine);
    } catch (const smlm::Error& e) {
      message_ = e.what();
      return e.exit_code();
    }
    return 0;
  }
  static std::string content(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  support::TemporaryDirectory directory_;
  Progress progress_;
  std::string message_;
};

TEST_F(Run, WritesACompleteDirectory) {
  ASSERT_EQ(fault({}), 0);
  for (const char* name : {"poses.csv", "results.h5", "aligned.hdf", "template.hdf", "aligned.csv",
                           "preview.png", "report.html", "summary.json"})
    EXPECT_TRUE(std::filesystem::is_regular_file(out(name))) << name;
  EXPECT_FALSE(std::filesystem::exists(out(".polar.lock")));
  const std::vector<PoseRow> poses = read_pose_table(out("poses.csv"));
  ASSERT_EQ(poses.size(), 4u);
  EXPECT_TRUE(poses[3].accepted);
  // Unturned particles that stay have no rotation error at all against the truth.
  EXPECT_LT(compare_poses(poses, read_pose_table(directory_.path("data/poses.csv")), {}).median_pair_deg,
            1e-6);
}

TEST_F(Run, RefusesWhatIsThereUnlessTold) {
  ASSERT_EQ(fault({}), 0);
  EXPECT_EQ(fault({}), 4);
  EXPECT_THAT(message_, HasSubstr("--overwrite or --resume"));
  EXPECT_EQ(fault({true, false}), 0);
}

TEST_F(Run, ResumeKeepsACompleteResultOfTheSameInput) {
  ASSERT_EQ(fault({}), 0);
  const Engine must_not_run = [](const Views&, const RegistrationOptions&, Progress&,
                                 Checkpoint&) -> Registration { throw std::logic_error("computed again"); };
  EXPECT_EQ(fault({false, true}, must_not_run), 0);
  std::ofstream(directory_.path("data/localisations.csv"), std::ios::app) << "1,1,1,1,1,1,1,1,1,1\n";
  EXPECT_EQ(fault({false, true}, must_not_run), 3);
  EXPECT_THAT(message_, HasSubstr("another input"));
}

TEST_F(Run, ResumeComputesWhatIsIncomplete) {
  ASSERT_EQ(fault({}), 0);
  std::filesystem::remove(out("summary.json"));
  EXPECT_EQ(fault({false, true}), 0);
  EXPECT_TRUE(std::filesystem::exists(out("summary.json")));
}

TEST_F(Run, ResolutionOfHalvesIsRecordedAndPartOfTheComputation) {
  ASSERT_EQ(fault({}), 0);
  EXPECT_THAT(content(out("summary.json")), ::testing::Not(HasSubstr("\"resolution\"")));
  write_config("input: {files: data/localisations.csv}\noutput: {resolution: halves}\n");
  EXPECT_EQ(fault({false, true}), 3);  // a result without halves is not this one
  ASSERT_EQ(fault({true, false}), 0);
  const auto summary = nlohmann::json::parse(content(out("summary.json")));
  EXPECT_EQ(summary["resolution"]["halves"]["particles"], (std::vector<int>{2, 2}));
  const smlm::h5::File file = smlm::h5::File::open(out("results.h5"));
  EXPECT_EQ(file.read<double>("/resolution/halves/correlation").size(),
            file.read<double>("/resolution/halves/frequency_per_nm").size());
  EXPECT_TRUE(file.exists("/resolution/noise"));
  write_config("input: {files: data/localisations.csv}\noutput: {resolution: thirds}\n");
  EXPECT_THROW(config(), smlm::Error);
}

TEST_F(Run, ThePageIsMadeWhateverElseIsAskedForAndTheRecordSaysWhereItComesFrom) {
  write_config("input: {files: data/localisations.csv}\noutput: {formats: [csv]}\n");
  RunFlags flags;
  flags.command = "polar run run.yaml";
  ASSERT_EQ(fault(flags), 0);
  EXPECT_FALSE(std::filesystem::exists(out("results.h5")));
  const std::string page = content(out("report.html"));
  EXPECT_THAT(page, HasSubstr("polar run run.yaml"));
  EXPECT_THAT(page, HasSubstr("<title>results - polar</title>"));
  const std::string table = content(directory_.path("data/localisations.csv"));
  EXPECT_THAT(page, HasSubstr(sha256(table.data(), table.size())));
  write_config("input: {files: data/localisations.csv}\noutput: {report: false}\n");
  ASSERT_EQ(fault({true, false}), 0);
  EXPECT_FALSE(std::filesystem::exists(out("report.html")));
}

TEST_F(Run, NamesTheWeightsThatTookPartAndNoOthers) {
  ASSERT_EQ(fault({}), 0);
  EXPECT_THAT(content(out("summary.json")), ::testing::Not(HasSubstr("weights_sha256")));
  const Engine with_weights = [](const Views& views, const RegistrationOptions& options, Progress& progress,
                                 Checkpoint& checkpoint) {
    Registration r = stay(views, options, progress, checkpoint);
    r.weights_sha256 = std::string(64, 'a');
    return r;
  };
  ASSERT_EQ(fault({true, false}, with_weights), 0);
  EXPECT_EQ(nlohmann::json::parse(content(out("summary.json")))["weights_sha256"], std::string(64, 'a'));
  EXPECT_EQ(smlm::h5::File::open(out("results.h5")).read_string_attribute("/run", "weights_sha256"),
            std::string(64, 'a'));
}

TEST_F(Run, OverwriteLeavesNothingOfTheEarlierRun) {
  ASSERT_EQ(fault({}), 0);
  std::ofstream(out("mine.txt")) << "kept";
  write_config("input: {files: data/localisations.csv}\noutput: {formats: [csv], preview: false}\n");
  ASSERT_EQ(fault({true, false}), 0);
  EXPECT_FALSE(std::filesystem::exists(out("results.h5")));
  EXPECT_TRUE(std::filesystem::exists(out("aligned.csv")));
  EXPECT_TRUE(std::filesystem::exists(out("mine.txt")));
}

TEST_F(Run, UnfitParticlesKeepTheirLines) {
  write_config(
      "input:\n  files: data/localisations.csv\n  filters: {x_nm: [-.inf, 1.e+6]}\n"
      "  particle_limits: {localisations: [1, .inf]}\n");
  ASSERT_EQ(fault({}), 0) << message_;
  std::uint64_t most = 0, second = 0;
  for (const PoseRow& row : read_pose_table(out("poses.csv"))) {
    second = std::max(second, std::min(most, row.n_localisations));
    most = std::max(most, row.n_localisations);
  }
  ASSERT_LT(second, most);
  write_config("input:\n  files: data/localisations.csv\n  particle_limits: {localisations: [0, " +
               std::to_string(second) + "]}\n");
  ASSERT_EQ(fault({true, false}), 0) << message_;
  const std::vector<PoseRow> poses = read_pose_table(out("poses.csv"));
  ASSERT_EQ(poses.size(), 4u);
  int left_out = 0;
  for (const PoseRow& row : poses) {
    left_out += row.accepted ? 0 : 1;
    if (!row.accepted) {
      EXPECT_EQ(row.n_localisations, most);
      EXPECT_THAT(row.reason, HasSubstr("left out: more than"));
    }
  }
  EXPECT_EQ(left_out, 1);
  const smlm::h5::File record = smlm::h5::File::open(out("results.h5"));
  EXPECT_THAT(record.read_strings("/run/configuration").front(), HasSubstr("localisations: [0, "));
  write_config("input: {files: data/localisations.csv, particle_limits: {localisations: [0, 1]}}\n");
  EXPECT_EQ(fault({true, false}), 3);
  EXPECT_THAT(message_, HasSubstr("widen the limits"));
}

TEST_F(Run, CancelledRunsWriteNothing) {
  Cancelling cancelling;
  EXPECT_TRUE(run(config(), {}, cancelling, stay).cancelled);
  EXPECT_TRUE(std::filesystem::is_empty(out()));
}

TEST_F(Run, ToReplaceAndGoOnDropsOnlyACheckpointOfAnotherComputation) {
  const Engine stopped = [](const Views& v, const RegistrationOptions& o, Progress& p, Checkpoint& c) {
    c.keep("state", "of the first");
    return stay(v, o, p, c);
  };
  std::optional<std::string> found;
  const Engine goes_on = [&](const Views& v, const RegistrationOptions& o, Progress& p, Checkpoint& c) {
    found = c.load("state");
    return stay(v, o, p, c);
  };
  const RunFlags both{true, true, {}};
  ASSERT_EQ(fault({}), 0);  // an earlier result, of another input
  std::ofstream(directory_.path("data/localisations.csv"), std::ios::app) << "1,1,1,1,1,1,1,1,1,1\n";
  Cancelling cancelling;
  ASSERT_TRUE(run(config(), both, cancelling, stopped).resumable);
  ASSERT_EQ(fault(both, goes_on), 0) << message_;
  EXPECT_EQ(found, "of the first");
  ASSERT_TRUE(run(config(), {true, false, {}}, cancelling, stopped).resumable);
  std::ofstream(directory_.path("data/localisations.csv"), std::ios::app) << "2,1,1,1,1,1,1,1,1,1\n";
  EXPECT_EQ(fault({false, true, {}}, goes_on), 3);
  ASSERT_EQ(fault(both, goes_on), 0) << message_;
  EXPECT_EQ(found, std::nullopt);
}

TEST_F(Run, NothingRegisteredIsNumericalAndLeavesItsAccount) {
  const Engine none = [](const Views& views, const RegistrationOptions& o, Progress& p, Checkpoint& c) {
    Registration r = stay(views, o, p, c);
    for (RegisteredView& v : r.view) {
      v.accepted = false;
      v.reason = "too few localisations";
    }
    return r;
  };
  EXPECT_EQ(fault({}, none), 5);
  EXPECT_THAT(message_, HasSubstr("too few localisations"));
  EXPECT_THAT(content(out("report.html")), HasSubstr("No structure found"));
  EXPECT_FALSE(std::filesystem::exists(out("summary.json")));  // not a result
  EXPECT_EQ(fault({}, none), 5);                               // and not in the way
  EXPECT_EQ(fault({}), 0);
  EXPECT_EQ(fault({}, none), 4);  // of a result that is complete
  EXPECT_EQ(fault({true, false}, none), 5);
  EXPECT_FALSE(std::filesystem::exists(out("aligned.csv")));  // nothing of the earlier one beside it
  std::filesystem::remove_all(out());
  write_config("input: {files: data/localisations.csv}\noutput: {report: false}\n");
  EXPECT_EQ(fault({}, none), 5);
  EXPECT_TRUE(std::filesystem::is_empty(out()));
}

TEST_F(Run, UnusableOutputDirectoriesFailBeforeComputing) {
  const Engine must_not_run = [](const Views&, const RegistrationOptions&, Progress&,
                                 Checkpoint&) -> Registration { throw std::logic_error("computed"); };
  std::ofstream(directory_.path("results")) << "a file";
  EXPECT_EQ(fault({}, must_not_run), 4);
  EXPECT_THAT(message_, HasSubstr("not a directory"));
  std::filesystem::remove(directory_.path("results"));
  std::filesystem::create_directory(out());
  const int lock = ::open(out(".polar.lock").c_str(), O_RDWR | O_CREAT, 0666);
  ASSERT_EQ(::flock(lock, LOCK_EX), 0);
  EXPECT_EQ(fault({}, must_not_run), 4);
  EXPECT_THAT(message_, HasSubstr("another process"));
  ::close(lock);  // as when that process dies: its lock file stays, and means nothing
  EXPECT_EQ(fault({}), 0);
}

TEST_F(Run, TooFewParticlesAreAnInputFault) {
  std::ofstream(directory_.path("data/localisations.csv"))
      << "x [nm],y [nm],z [nm],uncertainty_x [nm],uncertainty_y [nm],uncertainty_z [nm],particle\n"
         "1,2,3,1,1,1,a\n2,3,1,1,1,1,a\n";
  EXPECT_EQ(fault({}), 3);
  EXPECT_THAT(message_, HasSubstr("1 particle"));
}

TEST_F(Run, ConfigurationFaults) {
  const auto code = [&](const std::string& text) {
    write_config(text);
    try {
      config();
    } catch (const smlm::Error& e) {
      message_ = e.what();
      return e.exit_code();
    }
    return 0;
  };
  EXPECT_EQ(code("input: {}\n"), 2);
  EXPECT_THAT(message_, HasSubstr("input.files is missing"));
  EXPECT_EQ(code("input: {files: none.csv}\n"), 3);
  EXPECT_THAT(message_, HasSubstr("none.csv"));
  EXPECT_EQ(code("input: {files: [data/localisations.csv, data/local*.csv]}\n"), 2);
  EXPECT_THAT(message_, HasSubstr("listed twice"));
  EXPECT_EQ(code("input: {files: data/*.csv, format: cvs}\n"), 2);
  EXPECT_EQ(code("input: {files: data/*.csv}\nregistration: {symetry: C8}\n"), 2);
  EXPECT_THAT(message_, HasSubstr("did you mean 'registration.symmetry'?"));
  EXPECT_EQ(code("input: {files: data/*.csv}\nregistration: {symmetry: C8x}\n"), 2);
  EXPECT_EQ(code("input: {files: data/*.csv}\nregistration: {search: slow}\n"), 2);
  EXPECT_EQ(code("input: {files: data/*.csv}\nregistration: {method: guess}\n"), 2);
  EXPECT_THAT(message_, HasSubstr("registration.method is 'guess'"));
  EXPECT_EQ(code("input: {files: data/*.csv, particles: picked}\n"), 2);
  EXPECT_THAT(message_, HasSubstr("input.pick.radius_nm"));
  EXPECT_EQ(code("input: {files: data/*.csv}\noutput: {formats: [hdf6]}\n"), 2);
  EXPECT_EQ(code("input: {files: data/*.csv, columns: {x: {name: a, unit: px, knd: std}}}\n"), 2);
  EXPECT_THAT(message_, HasSubstr("did you mean 'input.columns.x.kind'?"));
}

TEST_F(Run, DefaultFileEqualsTheStructs) {
  std::ifstream in(POLAR_SOURCE_DIR "/configs/default.yaml");
  std::string text{std::istreambuf_iterator<char>(in), {}};
  const std::string none = "files: []";
  ASSERT_NE(text.find(none), std::string::npos);
  text.replace(text.find(none), none.size(), "files: [data/localisations.csv]");
  write_config(text);
  const std::string shipped = run_config_text(config());
  write_config("input: {files: [data/localisations.csv]}\n");
  EXPECT_EQ(shipped, run_config_text(config()));
  // The shipped file holds every key: as many "key:" lines as the effective configuration.
  const auto keys = [](const std::string& yaml) {
    std::vector<std::string> found;
    std::istringstream lines(yaml);
    for (std::string line; std::getline(lines, line);) {
      const std::size_t begin = line.find_first_not_of(' '), colon = line.find(':');
      if (begin != std::string::npos && line[begin] != '#' && colon != std::string::npos)
        found.push_back(line.substr(0, colon));
    }
    return found;
  };
  EXPECT_EQ(keys(text), keys(shipped));
}

TEST_F(Run, EffectiveConfigurationReadsBack) {
  write_config(
      "input:\n  files: [data/localisations.csv]\n  columns: {x: {name: \"x [nm]\", unit: px, kind: std}}\n"
      "  pixel_size_nm: 130\nregistration: {seed: 9, starts: [random]}\noutput: {voxel_nm: 1.5}\n");
  const std::string once = run_config_text(config());
  write_config(once);
  EXPECT_EQ(run_config_text(config()), once);
  EXPECT_THAT(once, HasSubstr("seed: 9"));
}

}  // namespace
}  // namespace polar

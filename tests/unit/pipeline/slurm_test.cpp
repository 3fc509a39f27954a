#include "polar/pipeline/slurm.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "pipeline/program.hpp"
#include "pipeline/slurm_script.hpp"
#include "polar/pipeline/simulate_run.hpp"
#include "smlm/error.hpp"
#include "support/stand_in_engine.hpp"
#include "support/temporary_directory.hpp"

namespace polar {
namespace {

using pipeline::run_program;
using pipeline::slurm_script_text;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

template <class Work>
void expect_fault(int code, const std::string& part, const Work& work) {
  try {
    work();
    ADD_FAILURE() << "no fault: " << part;
  } catch (const smlm::Error& e) {
    EXPECT_EQ(e.exit_code(), code) << e.what();
    EXPECT_THAT(e.what(), HasSubstr(part));
  }
}

TEST(Program, BothStreamsAndTheExitCodeArrive) {
  const auto end = run_program({"sh", "-c", "echo out; echo err >&2; exit 3"});
  EXPECT_EQ(end.code, 3);
  EXPECT_EQ(end.output, "out\n");
  EXPECT_EQ(end.errors, "err\n");
  EXPECT_EQ(run_program({"sh", "-c", "kill -KILL $$"}).code, 128 + 9);
  // More than a pipe holds, on the stream that is read last.
  EXPECT_EQ(run_program({"sh", "-c", "head -c 300000 /dev/zero >&2"}).errors.size(), 300000u);
  expect_fault(6, "no-such-program: cannot be started: No such file",
               [] { run_program({"no-such-program"}); });
}

TEST(SlurmScript, HoldsAnyNameAndOptionAsAShellReadsThem) {
  const std::vector<std::string> names = {"cell 1", "it's", "$(false)", "new\nline", "{{polar}}"};
  const std::string script = slurm_script_text({names, {"/bin/polar", "batch", "a b.yaml"}, 4},
                                               "#!/bin/bash\nnames=({{names}}); polar=({{polar}})\n"
                                               "printf '%s|' \"${names[@]}\" \"${polar[@]}\" {{restarts}}\n",
                                               "t.sh");
  EXPECT_EQ(run_program({"bash", "-c", script}).output,
            "cell 1|it's|$(false)|new\nline|{{polar}}|/bin/polar|batch|a b.yaml|4|");
}

TEST(SlurmScript, ATemplateThatCannotBeUsedIsRefused) {
  const auto refused = [](const std::string& text, const std::string& part) {
    expect_fault(2, part, [&] { slurm_script_text({{"a"}, {"polar"}, 1}, text, "t.sh"); });
  };
  refused("#!/bin/sh\n{{names}}\n{{poler}}\n",
          "t.sh:3: nothing is called {{poler}}: did you mean {{polar}}?");
  refused("#!/bin/sh\n{{names}}\n", "t.sh: {{polar}} is missing");
  refused("#!/bin/sh\n{{polar}} {{names\n}}", "t.sh:2: {{ is not closed");
  refused("{{polar}} {{names}}", "t.sh:1: the script does not begin");
}

class SlurmTest : public ::testing::Test {
 protected:
  SlurmTest() {
    SimulateConfig simulation;
    simulation.simulation.particles = 4;
    simulation.simulation.cramer_rao = false;
    for (const char* folder : {"data/1", "data/2", "data/3"}) {
      simulation.directory = directory_.path(folder);
      run_simulation(simulation, false);
    }
    std::ofstream(directory_.path("batch.yaml"))
        << "datasets: {folders: data/*, input: localisations.csv}\noutput: {directory: 'of 100 %'}\n";
  }
  ~SlurmTest() override { ::setenv("PATH", path_.c_str(), 1); }

  // A program that keeps the words it is given and answers as sbatch does.
  void stand_in(const std::string& body) {
    const std::string file = directory_.path("bin/sbatch");
    std::filesystem::create_directories(directory_.path("bin"));
    std::ofstream(file) << "#!/bin/sh\nprintf '%s\\n' \"$@\" >> " << directory_.path("words") << "\n" << body;
    std::filesystem::permissions(file, std::filesystem::perms::owner_all);
    ::setenv("PATH", (directory_.path("bin") + ":" + path_).c_str(), 1);
  }
  SlurmBatch batch(const BatchFlags& flags = {}, const SlurmOptions& options = {}) {
    return slurm_batch(load_batch_config(directory_.path("batch.yaml"), {}), flags, options,
                       {"/bin/polar", "batch", "batch.yaml"}, progress_);
  }
  std::string content(const std::string& path) {
    std::ifstream in(path);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  support::TemporaryDirectory directory_;
  Progress progress_;
  const std::string path_ = std::getenv("PATH");
};

TEST_F(SlurmTest, ATaskForWhatIsNotComplete) {
  BatchFlags flags;
  flags.only = {"2"};
  run_batch(load_batch_config(directory_.path("batch.yaml"), {}), flags, progress_, support::stay);
  EXPECT_THAT(batch().names, ElementsAre("1", "3"));
  EXPECT_TRUE(batch(flags).names.empty());
  flags.only = {"33"};
  expect_fault(2, "did you mean '3'?", [&] { batch(flags); });
  // One that cannot be run has its task, too, which says why when it still cannot.
  std::filesystem::remove(directory_.path("data/3/localisations.csv"));
  EXPECT_THAT(batch().names, ElementsAre("1", "3"));
}

TEST_F(SlurmTest, TheWordsOfSbatch) {
  SlurmOptions options;
  options.partition = "short";
  options.time = "1:00:00";
  options.memory = "4G";
  options.cpus = 8;
  options.at_once = 2;
  options.notice_s = 300;
  options.more = {"account=imaging", "exclusive"};
  const SlurmBatch b = batch({}, options);
  const std::string tasks = directory_.path("of 100 %/tasks/");
  const std::string escaped = directory_.path("of 100 %%/tasks/");
  EXPECT_THAT(b.tasks,
              ElementsAre("sbatch", "--parsable", "--open-mode=append", "--job-name=polar-of 100 %",
                          "--partition=short", "--time=1:00:00", "--mem=4G", "--account=imaging",
                          "--exclusive", "--array=1-3%2", "--requeue", "--signal=B:USR1@300",
                          "--cpus-per-task=8", "--output=" + escaped + "%A_%a.log", tasks + "batch.sh"));
  EXPECT_THAT(b.tables, ElementsAre("sbatch", "--parsable", "--open-mode=append", "--job-name=polar-of 100 %",
                                    "--partition=short", "--time=1:00:00", "--mem=4G", "--account=imaging",
                                    "--exclusive", "--output=" + escaped + "%j.log", tasks + "batch.sh"));
  EXPECT_THAT(slurm_text(b), HasSubstr("\n# job=$(sbatch --parsable"));
  EXPECT_THAT(slurm_text(b), HasSubstr("\n# sbatch --dependency=afterany:$job --parsable"));
}

TEST_F(SlurmTest, SubmitsTheTasksAndWhatFollowsThem) {
  stand_in("echo 'a word of the site' >&2\necho '17;cluster'\n");
  const SlurmBatch b = batch();
  EXPECT_THAT(submit(b)[0], HasSubstr("3 data sets as job 17"));
  const std::string words = content(directory_.path("words"));
  EXPECT_THAT(words, HasSubstr("--array=1-3\n"));
  EXPECT_THAT(words, HasSubstr("--dependency=afterany:17\n"));
  EXPECT_EQ(content(b.script_file), slurm_text(b));
  EXPECT_THAT(content(b.script_file), HasSubstr("names=(1 2 3)\npolar=(/bin/polar batch batch.yaml)\n"));
}

TEST_F(SlurmTest, WhatSbatchSaysIsInTheFault) {
  stand_in("echo 'sbatch: error: invalid partition' >&2\nexit 1\n");
  expect_fault(6, "sbatch: the jobs were not taken: sbatch: error: invalid partition: --print",
               [&] { submit(batch()); });
  stand_in("case \"$*\" in *--array*) echo 17 ;; *) exit 1 ;; esac\n");
  expect_fault(6, "job 17 with the data sets was taken: --gather", [&] { submit(batch()); });
}

TEST_F(SlurmTest, AnOwnTemplateIsReadAndTheShippedOneIsAFile) {
  SlurmOptions options;
  options.template_file = directory_.path("own.sh");
  expect_fault(2, "own.sh: cannot be read", [&] { batch({}, options); });
  std::ofstream(options.template_file) << "#!/bin/sh\n# {{names}} {{polar}}\n";
  EXPECT_EQ(batch({}, options).script, "#!/bin/sh\n# 1 2 3 /bin/polar batch batch.yaml\n");
  options.template_file = POLAR_SOURCE_DIR "/configs/batch_slurm.sh";
  EXPECT_EQ(batch({}, options).script, batch().script);
}

}  // namespace
}  // namespace polar

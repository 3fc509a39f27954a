import fcntl
import json
import os
import random
import resource
import shutil
import signal
import subprocess
import sys
import time
import unittest
from pathlib import Path

from harness import HEADER, POLAR, QUICK, SMALL, PolarCase

ORIGAMI = Path(__file__).resolve().parents[2] / "configs/studies/structures/origami.csv"
PORES = "simulation: {particles: 30, blinks_mean: 10, sigma_xy_nm: [2, 5], cramer_rao: true}"


class Usage(PolarCase):
    def test_version_and_help_go_to_stdout(self):
        self.assertRegex(self.ok("--version"), r"^polar \d+\.\d+\.\d+ \(commit \w+\)$")
        self.assertIn("evaluate", self.ok("--help"))

    def test_wrong_usage_is_2(self):
        self.fails(2, "polar --help")
        self.fails(2, "polar --help", "fly")
        self.fails(2, "polar --help", "run", "--fast")
        self.fails(2, "no such file", "run", "none.yaml")
        self.simulate(SMALL)
        config = self.run_config()
        self.fails(2, "excludes", "run", config, "--overwrite", "--resume")
        self.fails(2, "threads", "run", config, "--threads", "-1")

    def test_configuration_faults_name_key_and_line(self):
        self.simulate(SMALL)
        self.fails(2, "run.yaml:2: unknown key 'registration.serch': did you mean 'registration.search'?",
                   "run", self.run_config(more="registration: {serch: fast}\n"))
        self.fails(2, "did you mean 'registration.seed'", "run", self.run_config(), "--set", "registration.sed=1")
        self.fails(2, "occurs twice", "run", self.run_config(more="output: {voxel_nm: 1, voxel_nm: 2}\n"))
        self.fails(2, "registration.seed", "run", self.run_config(more="registration: {seed: -3}\n"))

    def test_inspect_reads_a_table_with_overrides(self):
        rows = "".join(f"{i},{2 * i},{i % 2}\n" for i in range(20))
        table = self.write("pixels.csv", "x,y,particle\n" + rows)
        pixels = ("--set", "input.unit=pixel")
        self.fails(3, "set input.pixel_size_nm", "inspect", table, *pixels)
        said = json.loads(self.ok("inspect", table, *pixels, "--set", "input.pixel_size_nm=100", "--json"))
        self.assertEqual([c["maximum"] for c in said["columns"] if c["name"] == "x"], [1900])
        short = self.ok("inspect", table, *pixels, "--pixel-size-nm", "100", "--format", "csv", "--json")
        self.assertEqual(json.loads(short), said)
        self.fails(2, "input.format", "inspect", table, "--format", "tsv")
        self.fails(2, "input.pixelsize", "inspect", table, "--set", "input.pixelsize=100")
        self.fails(2, "named as arguments", "inspect", table, "--set", "input.files=other.csv")

    def test_inspect_takes_its_options_with_a_configuration_too(self):
        self.write("a.csv", "x [nm],y [nm]\n1,2\n3,4\n")
        self.write("b.csv", "x [nm],y [nm]\n5,6\n7,8\n")
        config = self.write("two.yaml", "input: {files: [a.csv, b.csv]}\n")
        self.assertEqual(json.loads(self.ok("inspect", config, "--json"))["particles"], 0)
        self.assertEqual(json.loads(self.ok("inspect", config, "--one-per-file", "--json"))["particles"], 2)


class BadInput(PolarCase):
    def refused(self, content, part, more=""):
        self.write("table.csv", content)
        self.fails(3, part, "run", self.run_config("table.csv", more))
        self.assertFalse((self.folder / "results" / "poses.csv").exists())

    def test_tables_that_hold_nothing(self):
        self.refused("", "table.csv")
        self.refused(HEADER, "table.csv")
        self.refused(HEADER + "1,2,3,1,1,1,a\n", "1 particle")

    def test_numbers_that_are_none(self):
        good = "1,2,3,1,1,1,a\n4,5,6,1,1,1,b\n"
        self.refused(HEADER + good + "nan,2,3,1,1,1,a\n", "table.csv:4")
        self.refused(HEADER + good + "1.2abc,2,3,1,1,1,a\n", "table.csv:4")
        self.refused(HEADER + good + "1,2,3,0,1,1,a\n", "table.csv:4")
        self.refused(HEADER + good + "1,2,3\n", "table.csv:4")

    def test_files_that_are_no_tables(self):
        self.refused(bytes(range(256)) * 64, "table.csv")
        self.refused(b"\x89HDF\r\n\x1a\n" + b"\0" * 100, "table.csv")
        (self.folder / "folder.csv").mkdir()
        self.fails(3, "folder.csv", "run", self.run_config("folder.csv"))
        self.fails(3, "no such file", "run", self.run_config("missing/*.csv"))

    def test_evaluate_names_the_file(self):
        self.write("a.csv", "x,y\n1,2\n")
        self.fails(3, "a.csv:1", "evaluate", "a.csv", "--truth", "a.csv")
        self.fails(3, "none.csv", "evaluate", "none.csv", "--truth", "a.csv")
        data = self.simulate(SMALL)
        self.fails(2, "rotation group", "evaluate", data, "--truth", data / "poses.csv", "--symmetry", "C0")

    def test_export_needs_a_record(self):
        self.fails(4, "results.h5", "export", "results.h5", "--to", "csv")
        self.write("results.h5", "not HDF5")
        self.fails(3, "results.h5", "export", "results.h5", "--to", "csv")
        self.fails(2, "--to", "export", "results.h5", "--format", "jpeg")

    def test_memory_limit_is_6(self):
        config = self.write("big.yaml", "simulation: {particles: 20000, sampling: points, points: 20000,"
                            " cramer_rao: false}\n")

        def limited():
            resource.setrlimit(resource.RLIMIT_AS, (1 << 28, 1 << 28))
        self.fails(6, "memory", "simulate", config, preexec_fn=limited)


class Outputs(PolarCase):
    def test_directory_faults_come_before_computing(self):
        self.simulate(SMALL)
        config = self.run_config()
        self.write("results", "a file")
        self.fails(4, "not a directory", "run", config)
        (self.folder / "results").unlink()
        self.write("results/mine.txt", "x")
        self.fails(4, "--overwrite or --resume", "run", config)

    def test_second_process_is_refused(self):
        self.simulate(SMALL)
        lock = self.write("results/.polar.lock", "")
        with open(lock, "w") as held:
            fcntl.flock(held, fcntl.LOCK_EX)
            self.fails(4, "another process", "run", self.run_config())

    def test_complete_directory_resume_export(self):
        self.simulate(SMALL)
        config = self.run_config(more=QUICK)
        stdout = self.ok("run", config)
        self.assertIn("accepted", stdout)
        results = self.folder / "results"
        names = {p.name for p in results.iterdir()}
        self.assertEqual(names, {"poses.csv", "results.h5", "aligned.hdf", "template.hdf", "aligned.csv",
                                 "preview.png", "report.html", "summary.json"})
        summary = json.loads((results / "summary.json").read_text())
        self.assertEqual(summary["particles"], 6)
        before = (results / "poses.csv").stat().st_mtime_ns
        self.assertIn("complete already", self.ok("run", config, "--resume"))
        self.assertEqual((results / "poses.csv").stat().st_mtime_ns, before)
        self.fails(3, "another input or configuration", "run", config, "--resume", "--set", "registration.seed=2")
        (self.folder / "again").mkdir()
        self.ok("export", results, "--to", "csv,vtkhdf,png", "--output", "again")
        for name in ("aligned.csv", "aligned.hdf", "template.hdf", "preview.png"):
            self.assertEqual((self.folder / "again" / name).read_bytes(), (results / name).read_bytes(), name)

    def test_logs(self):
        self.simulate(SMALL)
        config = self.run_config(more=QUICK)
        done = self.polar("run", config, "--quiet")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        done = self.polar("run", config, "--overwrite", "--json-log")
        self.assertEqual(done.returncode, 0, done.stderr)
        lines = [json.loads(line) for line in done.stderr.splitlines()]
        self.assertTrue(any(line["event"] == "progress" and line["done"] <= line["total"] for line in lines))

    def test_the_rate_of_a_resumed_training_is_that_of_its_own_steps(self):
        config = self.write("train.yaml", "training: {clouds_per_step: 2}\n"
                            "output: {weights: w.h5, checkpoint: c.h5}\n")
        self.ok("train", config, "--quiet", "--set", "training.steps=20")
        done = self.polar("train", config, "--json-log", "--set", "training.steps=40")
        self.assertEqual(done.returncode, 0, done.stderr)
        lines = [json.loads(line) for line in done.stderr.splitlines()]
        steps = [line for line in lines if line["event"] == "progress"]
        first, last = steps[0], steps[-1]
        self.assertEqual((first["done"], last["done"]), (21, 40))
        measured = (last["done"] - first["done"]) / (last["time_s"] - first["time_s"])
        self.assertLess(abs(last["rate_per_s"] / measured - 1), .2)


class FullDisk(PolarCase):
    FORMATS = ("vtkhdf", "csv", "png", "tiff", "ply", "picasso", "thunderstorm")

    def limited(self, limit):
        """Writes beyond `limit` bytes of a file fail, as they do on a full disk."""
        def limit_files():
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
        return {"preexec_fn": limit_files, "restore_signals": False}

    def test_every_format_fails_cleanly_wherever_the_disk_is_full(self):
        self.simulate(SMALL)
        self.ok("run", self.run_config(more=QUICK))
        (self.folder / "out").mkdir()
        for name in self.FORMATS:
            for limit in (0, 200, 5000, 20000):
                self.export_within(limit, name)

    def export_within(self, limit, name):
        done = self.polar("export", "results", "--to", name, "--output", "out", **self.limited(limit))
        out = self.folder / "out"
        if done.returncode == 0:  # small enough
            self.assertTrue(all(path.stat().st_size <= limit for path in out.iterdir()), (name, limit))
        else:
            self.assertEqual(done.returncode, 4, (name, limit, done.stderr))
            self.assertRegex(done.stderr, r"\Aerror: out/\w[^\n]+\n\Z")  # never a temporary name
            self.assertEqual(done.stdout, "")
            whole = {path.name for path in out.iterdir()}  # of two files the first may be there, never a part of one
            self.assertLessEqual(whole, {"aligned.hdf", "aligned.yaml", "aligned_particles.csv"}, (name, limit))
        for path in out.iterdir():
            path.unlink()

    def test_run_leaves_the_earlier_result_whole(self):
        self.simulate(SMALL)
        config = self.run_config(more=QUICK)
        self.ok("run", config)
        results = self.folder / "results"
        before = (results / "results.h5").read_bytes()
        self.fails(4, "results.h5", "run", config, "--overwrite", **self.limited(60000))
        self.assertEqual((results / "results.h5").read_bytes(), before)
        self.assertFalse((results / "summary.json").exists())  # so the directory does not count as complete
        self.assertEqual([path.name for path in results.iterdir() if path.name.endswith(".tmp")], [])
        self.ok("run", config, "--resume")
        self.assertTrue((results / "summary.json").exists())

    def test_results_that_stdout_swallows_are_an_error(self):
        self.simulate(SMALL)
        with open("/dev/full", "w") as full:
            done = subprocess.run([POLAR, "inspect", "data/localisations.csv"], cwd=self.folder, stdout=full,
                                  stderr=subprocess.PIPE, text=True, timeout=60)
        self.assertEqual(done.returncode, 4)
        self.assertIn("error: stdout: could not be written", done.stderr)


@unittest.skipUnless("FAULTY_IO" in os.environ, "faulty_io is not built")
class FaultyIo(PolarCase):
    """The n-th call fails, for every n until a run passes clean."""
    def test_every_call_that_fails_is_an_error_and_leaves_whole_files(self):
        self.simulate(SMALL)
        config = self.run_config(more=QUICK + "output: {formats: [csv], preview: false}\n")
        self.ok("run", config)
        whole = {name: (self.folder / "results" / name).read_bytes() for name in ("poses.csv", "aligned.csv")}
        for fault in ("fsync", "rename", "write"):
            nth = 1
            while self.failing(config, fault, nth, whole):
                nth += 1
            self.assertGreater(nth, 3, fault)
        for fault in ("short", "interrupted"):
            self.assertFalse(self.failing(config, fault, 2, whole))

    def failing(self, config, fault, nth, whole):
        env = {"LD_PRELOAD": os.environ["FAULTY_IO"], "FAULT": fault, "NTH": str(nth)}
        done = self.polar("run", config, "--overwrite", "--quiet", env=env)
        for name, content in whole.items():
            self.assertEqual((self.folder / "results" / name).read_bytes(), content, (fault, nth, name))
        left = {path.name for path in (self.folder / "results").iterdir()}
        self.assertLessEqual(left, {*whole, "report.html", "results.h5", "summary.json", "checkpoint.1", "checkpoint.2"}, (fault, nth))
        if done.returncode == 0:
            self.assertIn("summary.json", left)
            return False
        self.assertEqual(done.returncode, 4, (fault, nth, done.stderr))
        self.assertRegex(done.stderr, r"\Aerror: \S*/results(/\w[^\n]*)?: [^\n]+\n\Z")
        return True


class ClosedStreams(PolarCase):
    def test_nothing_is_printed_into_a_result(self):
        self.simulate(SMALL)
        self.run_config(more=QUICK)
        self.ok("run", "run.yaml", "--output", "open")
        done = subprocess.run(["sh", "-c", f"exec '{POLAR}' run run.yaml --output closed <&- >&- 2>&-"], cwd=self.folder,
                              timeout=300)
        self.assertEqual(done.returncode, 0)
        for name in ("poses.csv", "aligned.csv", "aligned.hdf", "template.hdf"):
            self.assertEqual((self.folder / "closed" / name).read_bytes(), (self.folder / "open" / name).read_bytes())


class Signals(PolarCase):
    def stop(self, number):
        process = subprocess.Popen([POLAR, "run", "run.yaml", "--overwrite"], cwd=self.folder, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE)
        lock = self.folder / "results" / ".polar.lock"
        for _ in range(200):
            if lock.exists():
                break
            time.sleep(0.05)
        time.sleep(1)  # inside the registration
        process.send_signal(number)
        process.send_signal(number)  # a batch system signals all of a job, and its script passes it on
        self.assertEqual(process.wait(timeout=120), 128 + number)
        process.communicate()
        left = {path.name for path in (self.folder / "results").iterdir()}
        self.assertLessEqual(left, {"checkpoint.1", "checkpoint.2"})
        shutil.rmtree(self.folder / "results")

    def test_signals_end_cleanly(self):
        self.simulate("simulation: {particles: 150, blinks_mean: 20, cramer_rao: false}")
        self.run_config()
        self.stop(signal.SIGTERM)
        self.stop(signal.SIGINT)


class Resume(PolarCase):
    """A run that is cut short at any instant goes on to the bits of one that was not."""
    TRIALS = int(os.environ.get("POLAR_KILL_TRIALS", "6"))
    FILES = ("poses.csv", "aligned.csv", "template.hdf")

    def setUp(self):
        super().setUp()
        self.simulate("simulation: {particles: 8, blinks_mean: 3, cramer_rao: false}")
        self.config = self.run_config(more="registration: {starts: [imaged]}\n"
                                           "output: {formats: [csv, vtkhdf], preview: false}\n")

    def interrupted(self, number, seconds, *arguments):
        """Whether the run was still there to be hit."""
        process = subprocess.Popen([POLAR, "run", self.config, "--quiet", *arguments], cwd=self.folder,
                                   stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        try:
            process.wait(seconds)
        except subprocess.TimeoutExpired:
            process.send_signal(number)
        process.communicate()
        self.assertIn(process.returncode, (0, -number, 128 + number))
        return process.returncode != 0

    def checkpoints(self):
        return sorted((self.folder / "results").glob("checkpoint.*"))

    def test_killed_at_random_instants(self):
        self.ok("run", self.config, "--output", "whole")
        begin = time.monotonic()
        self.ok("run", self.config, "--output", "timed")
        whole_s = time.monotonic() - begin
        expected = {name: (self.folder / "whole" / name).read_bytes() for name in self.FILES}
        instants = random.Random(self.TRIALS)
        hits = continued = 0
        for trial in range(self.TRIALS):
            number = (signal.SIGKILL, signal.SIGKILL, signal.SIGTERM)[trial % 3]
            hits += self.interrupted(number, instants.uniform(0, whole_s))
            for _ in range(2):
                hits += self.interrupted(signal.SIGKILL, instants.uniform(0, whole_s), "--resume")
            done = self.polar("run", self.config, "--resume")
            self.assertEqual(done.returncode, 0, done.stderr)
            continued += "continuing from" in done.stderr
            for name in self.FILES:
                self.assertEqual((self.folder / "results" / name).read_bytes(), expected[name], (trial, name))
            left = {path.name for path in (self.folder / "results").iterdir()}
            self.assertEqual(left, {*self.FILES, "aligned.hdf", "report.html", "summary.json"}, trial)
            shutil.rmtree(self.folder / "results")
        print(f"{self.TRIALS} trials, {hits} interruptions, {continued} continued from a checkpoint", file=sys.stderr)
        self.assertGreater(hits, 0)

    def test_checkpoints_of_others_and_damaged_ones_are_refused(self):
        self.assertTrue(self.interrupted_with_checkpoint(signal.SIGTERM))
        for path in self.checkpoints():
            path.write_bytes(path.read_bytes()[:-7])
        self.fails(3, "truncated checkpoint", "run", self.config, "--resume")
        for path in self.checkpoints():
            path.unlink()
        self.assertTrue(self.interrupted_with_checkpoint(signal.SIGUSR1, "--resume"))
        self.fails(4, "not empty", "run", self.config)
        self.fails(3, "another configuration", "run", self.config, "--resume", "--set", "registration.seed=2")
        table = self.folder / "data/localisations.csv"
        text = table.read_text()
        table.write_text(text.replace("\n", "\n ", 2))
        self.fails(3, "another input", "run", self.config, "--resume")
        table.write_text(text)
        self.ok("run", self.config, "--resume")
        self.assertEqual(self.checkpoints(), [])

    def interrupted_with_checkpoint(self, number, *arguments):
        process = subprocess.Popen([POLAR, "run", self.config, "--quiet", *arguments], cwd=self.folder,
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        while process.poll() is None and not self.checkpoints():
            time.sleep(0.001)
        process.send_signal(number)
        return process.wait() == 128 + number and self.checkpoints()


class KnownBeforehand(PolarCase):
    """Poses or a template that are known before the run."""
    def setUp(self):
        super().setUp()
        self.data = self.simulate("simulation: {particles: 12, blinks_mean: 8, sigma_xy_nm: [2, 4], cramer_rao: false}")
        self.config = self.run_config(more="registration: {symmetry: D8, starts: [imaged]}\n"
                                      "output: {formats: [hdf5, csv, sites], preview: false, report: false}\n"
                                      "expert: {proposals: {most_proposals: 0}, verdict: {draws: 1}}\n")

    def test_initial_poses(self):
        poses = self.data / "poses.csv"
        said = self.ok("run", self.config, "--set", f"registration.initial_poses={poses}")
        self.assertIn("start        the poses of registration.initial_poses", said)
        self.assertGreaterEqual(self.recall("results", poses, 10)[0], 0.9)
        lines = poses.read_text().splitlines(keepends=True)
        fewer = self.write("fewer.csv", "".join(lines[:-2]))
        done = self.polar("run", self.config, "--set", f"registration.initial_poses={fewer}", "--output", "again")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("has no pose of 2 particles", done.stderr)
        self.assertGreaterEqual(self.recall("again", poses, 10)[0], 0.8)
        self.fails(4, "No such file", "run", self.config, "--set", "registration.initial_poses=none.csv",
                   "--output", "third")

    def test_template(self):
        sites = self.data / "sites.csv"
        known = ("--set", "registration.starts=[template]", "--set")
        done = self.polar("run", self.config, *known, f"registration.template={sites}")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("could be the template's own", done.stderr)
        self.assertGreaterEqual(self.recall("results", self.data / "poses.csv", 10)[0], 0.9)
        self.ok("run", self.config, *known, f"registration.template={self.folder / 'results/results.h5'}",
                "--output", "again")
        self.assertGreaterEqual(self.recall("again", self.data / "poses.csv", 10)[0], 0.9)
        self.fails(2, "name its file as registration.template", "run", self.config, *known[:2])
        self.fails(2, "has no effect: add template", "run", self.config, "--set", f"registration.template={sites}")
        damaged = self.write("template.h5", "nothing of the kind")
        self.fails(3, "template.h5", "run", self.config, *known, f"registration.template={damaged}", "--output", "third")


class Recall(PolarCase):
    def test_pores_in_any_orientation(self):
        data = self.simulate(PORES)
        self.ok("run", self.run_config())
        recall, report = self.recall("results", data / "poses.csv", 10)
        self.assertEqual(report["symmetry"], "D8")
        self.assertGreaterEqual(recall, 0.9)
        # Half again above the bound that no unbiased estimator beats, and not below it by luck or by leak.
        bound = report["cramer_rao_pair_median_deg"]
        self.assertGreater(report["median_pair_deg"], 0.7 * bound)
        self.assertLess(report["median_pair_deg"], 2.5 * bound)
        self.assertLess(report["median_translation_nm"], 3)

    def test_tetrahedra(self):
        data = self.simulate("structure: {kind: tetrahedron}\n"
                             "simulation: {particles: 30, blinks_mean: 15, sigma_xy_nm: [3, 6],"
                             " labelling_efficiency: 1}")  # two of four sites do not tell an orientation
        self.ok("run", self.run_config())
        self.assertGreaterEqual(self.recall("results", data / "poses.csv", 10)[0], 0.9)

    def test_planar_rings(self):
        data = self.simulate("structure: {kind: nuclear_pore}\n"
                             "simulation: {particles: 80, planar: true, orientation: in_plane, blinks_mean: 6}")
        self.ok("run", self.run_config())
        self.assertGreaterEqual(self.recall("results", data / "poses.csv", 10)[0], 0.9)

    def test_planar_particles_that_lack_many_of_their_labels(self):
        # Their centres stray by a third of the radius, and one particle in six may be lost (a known loss,
        # docs/decisions/0001). Where half is missing they may be refused.
        for labelled, expected, may_refuse in ((0.8, 0.95, False), (0.6, 0.65, False), (0.5, 0.65, True)):
            with self.subTest(labelled=labelled):
                name = f"labelled_{round(100 * labelled)}"
                data = self.simulate(
                    f"structure: {{kind: file, file: {ORIGAMI}}}\n"
                    "simulation: {particles: 120, planar: true, orientation: in_plane, label_size_nm: 0.5,"
                    f" sampling: sites, labelling_efficiency: {labelled}, blinks_mean: 8, sigma_xy_nm: [2, 2]}}",
                    name)
                config = self.run_config(f"{name}/localisations.csv", f"output: {{directory: {name}_results}}")
                done = self.polar("run", config)
                self.assertIn(done.returncode, (0, 5) if may_refuse else (0,), done.stderr)
                if done.returncode == 0:
                    self.assertGreaterEqual(self.recall(f"{name}_results", data / "poses.csv", 10)[0], expected)

    def test_wrong_poses_are_told_apart(self):
        data = self.simulate(PORES)
        other = self.simulate(PORES.replace("30,", "30, seed: 2,"), "other")
        recall, _ = self.recall(other, data / "poses.csv", 10)
        self.assertLess(recall, 0.1)


class Determinism(PolarCase):
    def test_same_bits_for_any_number_of_threads_and_any_locale(self):
        self.simulate("simulation: {particles: 8, blinks_mean: 4, cramer_rao: false}")
        config = self.run_config()
        kept = ("poses.csv", "aligned.csv", "aligned.hdf", "template.hdf", "preview.png")
        first = None
        for threads, locale in (("1", "C"), ("2", "de_DE.UTF-8"), ("7", "tr_TR.UTF-8"), ("64", "C")):
            self.ok("run", config, "--overwrite", "--threads", threads, env={"LC_ALL": locale})
            content = {name: (self.folder / "results" / name).read_bytes() for name in kept}
            first = first or content
            for name in kept:
                self.assertEqual(content[name], first[name], f"{name} with {threads} threads")
        self.ok("run", config, "--overwrite", "--set", "registration.seed=2")
        self.assertNotEqual((self.folder / "results" / "poses.csv").read_bytes(), first["poses.csv"])


if __name__ == "__main__":
    unittest.main()

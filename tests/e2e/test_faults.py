"""Faults from outside: memory that runs out, odd files and names, terminals that are none."""
import contextlib
import json
import os
import pty
import random
import resource
import signal
import subprocess
import unittest

from harness import HEADER, POLAR, QUICK, SMALL, PolarCase

TINY = "simulation: {particles: 3, blinks_mean: 4, labelling_efficiency: 1, cramer_rao: false}"


class Memory(PolarCase):
    def setUp(self):
        super().setUp()
        self.simulate(TINY)
        self.config = self.run_config(more="registration: {starts: [imaged]}\n")
        self.ok("run", self.config)
        self.whole = self.poses()

    def poses(self):
        return (self.folder / "results" / "poses.csv").read_bytes()

    def ends_cleanly(self, *arguments, **options):
        """Whether the run was made; otherwise it said in one line that it got no memory."""
        done = self.polar("run", self.config, "--overwrite", "--quiet", *arguments, **options)
        self.assertEqual(self.poses(), self.whole)
        self.assertEqual([path for path in (self.folder / "results").glob(".*.tmp")], [])
        if done.returncode == 0:
            return True
        self.assertEqual(done.returncode, 6, done.stderr)
        self.assertRegex(done.stderr, r"\Aerror: (out of memory|no thread could be started): [^\n]+\n\Z")
        return False

    @unittest.skipUnless("FAULTY_MEMORY" in os.environ, "faulty_memory is not built")
    def test_the_nth_allocation_fails(self):
        # Without HDF5, which crashes where it gets no memory; the next test is about it.
        formats = ("--set", "output.formats=[csv]", "--set", "output.preview=false", "--set", "output.report=false")
        for fault in ("once", "always"):
            nth, made = 1, False
            while not made or nth < 5000:  # a cache can do without, so one success early on proves nothing
                made = self.ends_cleanly(*formats, env={"LD_PRELOAD": os.environ["FAULTY_MEMORY"],
                                                       "FAULT": fault, "NTH": str(nth)})
                nth = nth * 3 + 1
            self.assertGreater(nth, 8000, fault)  # about as many as such a run asks for

    def test_any_limit_on_the_address_space(self):
        megabytes, made = 60, False  # the program and its libraries are loaded in less
        while not made:
            limit = megabytes << 20
            made = self.ends_cleanly(
                preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (limit, limit)))
            megabytes += 5
        self.assertGreater(megabytes, 65)


class OddFiles(PolarCase):
    def setUp(self):
        super().setUp()
        self.data = self.simulate(TINY)
        os.mkfifo(self.folder / "pipe")
        os.symlink("loop", self.folder / "loop")

    def test_pipes_devices_and_loops_are_refused_at_once(self):
        for name in ("pipe", "/dev/zero", "data"):
            self.fails(3, "not a regular file", "run", self.run_config(name))
            self.fails(3, "not a regular file", "inspect", name)
        for name in ("pipe", "/dev/zero"):
            self.fails(2, "not a regular file", "run", name)
            self.fails(3, "not a regular file", "evaluate", name, "--truth", self.data / "poses.csv")
            self.fails(3, "not a regular file", "export", name, "--to", "csv")
        self.fails(4, "levels of symbolic links", "run", self.run_config("loop"))
        self.fails(4, "levels of symbolic links", "export", "loop", "--to", "csv")
        self.fails(2, "no such file", "run", "loop")

    def test_output_that_cannot_be(self):
        config = self.run_config()
        self.fails(4, "cannot be created", "run", config, "--output", "d" * 300)
        self.fails(4, "cannot be created", "run", config, "--output", "loop")
        self.fails(4, "not a directory", "run", config, "--output", "pipe")

    def test_names_are_only_bytes(self):
        name = b"new\nline $(touch told) \xe9.csv"
        os.rename(self.data / "localisations.csv", os.path.join(os.fsencode(self.data), name))
        config = self.run_config("data/new*.csv", more="registration: {starts: [imaged]}\n")
        done = self.polar("run", config, "--quiet", "--output", os.fsdecode(b"out \xe9"), errors="surrogateescape")
        self.assertEqual(done.returncode, 0, done.stderr)
        done = json.loads((self.folder / os.fsdecode(b"out \xe9") / "summary.json").read_text())
        self.assertEqual(done["particles"], 3)
        self.assertFalse((self.folder / "told").exists())

    def test_a_truth_that_says_something_else(self):
        (self.data / "truth.json").write_text('{"structure": 3}')
        self.fails(3, "truth.json", "evaluate", self.data, "--truth", self.data / "poses.csv")


class Surroundings(PolarCase):
    RUN = ("run", "run.yaml", "--overwrite", "--set", "registration.starts=[imaged]")

    def setUp(self):
        super().setUp()
        self.data = self.simulate("simulation: {particles: 8, blinks_mean: 3, cramer_rao: false, orientation: in_plane}")
        self.run_config()

    def on_a_terminal(self, **environment):
        """What the program draws on a terminal as its stderr."""
        ours, theirs = pty.openpty()
        with subprocess.Popen([POLAR, "run", "quick.yaml", "--overwrite"], cwd=self.folder,
                              stdout=subprocess.DEVNULL, stderr=theirs, env=environment) as process:
            os.close(theirs)
            drawn = b""
            with contextlib.suppress(OSError):  # what a terminal says when its other end is closed
                while part := os.read(ours, 4096):
                    drawn += part
        os.close(ours)
        self.assertEqual(process.returncode, 0, drawn)
        return drawn

    def test_terminals(self):
        self.simulate(SMALL, "small")
        self.run_config("small/localisations.csv", QUICK, "quick.yaml")
        self.assertIn(b"\r", self.on_a_terminal(TERM="xterm"))
        for environment in ({"TERM": "dumb"}, {}):  # neither a terminal that draws, nor HOME, nor PATH
            self.assertNotIn(b"\x1b", self.on_a_terminal(**environment))

    def test_a_reader_that_goes_away_ends_the_program(self):
        for arguments in (("--help",), ("inspect", "data/localisations.csv")):
            with subprocess.Popen([POLAR, *arguments], cwd=self.folder, stdout=subprocess.PIPE) as process:
                process.stdout.close()
            self.assertIn(process.returncode, (0, -signal.SIGPIPE))  # 0: it had said everything

    def test_every_instruction_set_finds_the_same_poses(self):
        differences = {"avx2": [], "avx512": []}  # one the processor lacks stands for the best it has
        for seed in ("1", "2", "3"):
            for isa in ("portable", *differences):
                self.ok(*self.RUN, "--quiet", "--output", isa, "--set", "registration.seed=" + seed,
                        env={"POLAR_ISA": isa})
            for isa, of_this_set in differences.items():
                report = json.loads(self.ok("evaluate", isa, "--truth", "portable/poses.csv", "--json"))
                self.assertEqual(report["compared"], 8)
                of_this_set.append(report["median_rotation_deg"])
        for of_this_set in differences.values():  # rounding may tip a pore over to another of eight like poses
            self.assertLess(sorted(of_this_set)[1], 0.05)  # single precision: 0.003 where none tips
            self.assertLess(max(of_this_set), 2)  # the uncertainty of a pose

    def test_noise_is_not_registered(self):
        for seed in range(1, 4):
            random_numbers = random.Random(seed)
            rows = "".join(",".join(f"{random_numbers.gauss(0, 30):.3f}" for _ in range(3)) + f",3,3,6,{i % 20}\n"
                           for i in range(20 * 60))
            self.write("data/localisations.csv", HEADER + rows)
            self.fails(5, "no structure in common", *self.RUN)

    def test_noise_with_a_sharp_outline_is_not_registered(self):
        random_numbers = random.Random(4)
        rows = ""
        for i in range(20 * 60):
            x = [random_numbers.gauss(0, 1) for _ in range(3)]
            scale = 50 * random_numbers.random() ** (1 / 3) / sum(a * a for a in x) ** 0.5
            rows += ",".join(f"{scale * a:.3f}" for a in x) + f",3,3,6,{i % 20}\n"
        self.write("data/localisations.csv", HEADER + rows)
        self.fails(5, "no structure in common", *self.RUN)


if __name__ == "__main__":
    unittest.main()

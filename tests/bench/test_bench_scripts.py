"""The benchmark scripts' own arithmetic, and that every study is one that the built program understands."""
import os
import sys
import tempfile
import unittest
from pathlib import Path

NOT_INSTALLED = 77
try:
    import numpy as np
    import yaml  # noqa: F401
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(NOT_INSTALLED)

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
from benchmark import peers, poses, report, runner, study  # noqa: E402
from benchmark.program import Failed, NothingRegistered, Program, Refused, alone, measured, process  # noqa: E402

POLAR = Path(os.environ.get("POLAR_PROGRAM", ROOT / "build/src/cli/polar"))
ROUNDING_DEG = 1e-6  # of doubles written with the shortest digits that read back


def pose_file(folder, name, quaternions):
    path = Path(folder) / name
    lines = ["particle,qw,qx,qy,qz"]
    lines += [f"{i + 1}," + (",".join(map(str, q)) if q is not None else ",,,") for i, q in enumerate(quaternions)]
    path.write_text("\n".join(lines) + "\n")
    return path


def about_z(degrees):
    half = np.radians(degrees) / 2
    return np.cos(half), 0.0, 0.0, np.sin(half)


class Poses(unittest.TestCase):
    def test_pair_errors_ignore_the_common_motion_and_bin_by_the_true_angle(self):
        with tempfile.TemporaryDirectory() as folder:
            truth = pose_file(folder, "truth.csv", [about_z(0), about_z(30), about_z(100)])
            # All turned by 70 degrees; the third is wrong by 20 more.
            found = pose_file(folder, "found.csv", [about_z(70), about_z(100), about_z(190)])
            initial, error = poses.pair_errors(found, truth)
        np.testing.assert_allclose(initial, [30, 100, 70], atol=ROUNDING_DEG)
        np.testing.assert_allclose(error, [0, 20, 20], atol=ROUNDING_DEG)
        bins = poses.recall_by_angle(initial, error)
        self.assertEqual([b["pairs"] for b in bins], [1, 1, 1, 0])
        self.assertEqual([b["recall"] for b in bins], [1.0, 0.0, 0.0, None])

    def test_a_missing_pose_is_a_wrong_one(self):
        with tempfile.TemporaryDirectory() as folder:
            truth = pose_file(folder, "truth.csv", [about_z(0), about_z(30), about_z(60)])
            found = pose_file(folder, "found.csv", [about_z(0), about_z(30), None])
            _, error = poses.pair_errors(found, truth)
        np.testing.assert_allclose(error, [0, 180, 180], atol=ROUNDING_DEG)


class Report(unittest.TestCase):
    def test_a_study_owns_only_its_own_lines(self):
        s = study.Study("some", "Some", "section", "Text.", "sweep", "x", [], {}, {}, {}, {})
        record = {"level": "quick", "views": 3, "objects": [], "version": "polar 1", "machine": "m", "date": "d",
                  "skipped": "", "points": [{"label": 1, "series": "", "recall_5": 0.25, "recall_10": 0.5,
                                             "median_deg": 2.0, "wall_s": 1.0, "cpu_s": 1.0, "peak_mib": 1.0, "load": 0.0}]}
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "page.md"
            path.write_text("before\n")
            report.write(s, record, path, Path(folder) / "figures")
            path.write_text(path.read_text() + "after\n")
            record["points"][0]["recall_10"] = 0.75
            report.write(s, record, path, Path(folder) / "figures")
            text = path.read_text()
        self.assertTrue(text.startswith("before\n") and text.endswith("after\n"))
        self.assertEqual(text.count("begin study some"), 1)
        self.assertIn("| 1 | 0.250 | 0.750 |", text)
        self.assertNotIn("0.500", text)


    def test_tables_keep_to_the_columns_of_documents(self):
        objects = [f"object_with_a_long_name {k}" for k in range(12)]
        point = {"label": 1, "series": "a series", "recall_5": 0.25, "recall_10": 0.5, "median_deg": 2.0, "wall_s": 1000.0,
                 "cpu_s": 1000.0, "peak_mib": 1000.0, "load": 0.0, "method": "a program, 2000 rotations", "note": "said " * 40}
        record = {"level": "full", "views": 3, "objects": objects, "version": "polar 1", "machine": "m " * 60, "date": "d",
                  "skipped": "", "points": [{**point, "object": o} for o in objects]}
        for kind in ("sweep", "peers"):
            s = study.Study("some", "Some", "section", "Text. " * 40, kind, "x", [], {}, {}, {}, {})
            for line in report.section(s, record, Path("nowhere"), Path("nowhere.md")):
                self.assertLessEqual(len(line), 110, line)


class Studies(unittest.TestCase):
    def test_every_point_is_understood_by_the_program(self):
        if not POLAR.is_file():
            self.skipTest(f"{POLAR} is not built")
        program = Program(POLAR, ROOT)
        for s in study.load_all(ROOT / "configs/studies"):
            for point in s.points:
                with self.subTest(study=s.name, point=point.label), tempfile.TemporaryDirectory() as folder:
                    settings = {**s.simulate, **point.simulate, "simulation.particles": 2,
                                "simulation.cramer_rao": False}
                    program.simulate(settings, Path(folder) / "data")
                    self.assertTrue((Path(folder) / "data/poses.csv").is_file())

    def test_an_unknown_key_is_refused(self):
        if not POLAR.is_file():
            self.skipTest(f"{POLAR} is not built")
        with tempfile.TemporaryDirectory() as folder, self.assertRaises(Refused):
            Program(POLAR, ROOT).simulate({"simulation.no_such_key": 1}, Path(folder) / "data")

    def test_no_object_is_symmetric_by_its_label(self):
        common = study.yaml.safe_load((ROOT / "configs/studies/common.yaml").read_text())
        labels = {o["label"] for level in study.LEVELS for o in common["objects"][level]}
        self.assertFalse(labels & set(common["symmetric_labels"]))


class Memory(unittest.TestCase):
    def test_the_peak_is_the_programs_own(self):
        here = bytearray(200 << 20)  # what this process holds must not count
        _, small = measured([sys.executable, "-S", "-c", "import time; time.sleep(0.3)"])
        _, large = measured([sys.executable, "-S", "-c",
                             "import time; x = bytearray(100 << 20); x[::4096] = b'1' * (25 << 10); time.sleep(0.3)"])
        self.assertEqual(len(here), 200 << 20)
        self.assertLess(small.peak_mib, 60)
        self.assertGreater(large.peak_mib, 100)
        self.assertLess(large.peak_mib, 160)


class Failures(unittest.TestCase):
    """A stand-in for the program that only ends with a code."""

    def ends_with(self, code):
        with tempfile.TemporaryDirectory() as folder:
            program = Path(folder) / "polar"
            program.write_text(f"#!/bin/sh\necho 'somewhere/made.yaml: the reason' >&2\nexit {code}\n")
            program.chmod(0o755)
            return Program(program, ROOT).run(Path(folder) / "data", {}, Path(folder) / "result")

    def test_a_refused_configuration_skips_the_study_and_says_why(self):
        with self.assertRaises(Refused) as caught:
            self.ends_with(2)
        self.assertEqual(str(caught.exception), "the reason")

    def test_nothing_registered_is_a_result_with_its_cost(self):
        with self.assertRaises(NothingRegistered) as caught:
            self.ends_with(5)
        self.assertGreater(caught.exception.cost.wall_s, 0)

    def test_anything_else_stops_the_benchmark(self):
        with self.assertRaises(Failed) as caught:
            self.ends_with(3)
        self.assertNotIsInstance(caught.exception, NothingRegistered)


class Limits(unittest.TestCase):
    def test_a_program_is_cut_off_at_its_processor_time(self):
        ended = process([sys.executable, "-S", "-c", "while True: pass"], limit_cpu_s=0.2)
        self.assertTrue(ended.cut_off)
        self.assertGreater(ended.cost.cpu_s, 0.1)
        self.assertLess(ended.cost.cpu_s, 5)

    def test_sleeping_costs_no_processor_time(self):
        ended = process([sys.executable, "-S", "-c", "import time; time.sleep(0.5); print('done')"], limit_cpu_s=0.4)
        self.assertFalse(ended.cut_off)
        self.assertEqual((ended.code, ended.out), (0, "done\n"))

    def test_runs_with_one_lock_take_turns(self):
        with tempfile.TemporaryDirectory() as folder:
            lock = Path(folder) / "lock"
            probe = f"import fcntl; fcntl.flock(open({str(lock)!r}, 'a'), fcntl.LOCK_EX | fcntl.LOCK_NB)"
            with alone(lock):
                self.assertEqual(process([sys.executable, "-c", probe]).code, 1)
            self.assertEqual(process([sys.executable, "-c", probe]).code, 0)


class Peers(unittest.TestCase):
    def test_a_program_that_is_not_installed_is_said_and_not_kept(self):
        with tempfile.TemporaryDirectory() as folder:
            python = Path(folder) / "python"
            python.write_text(f"#!/bin/sh\necho 'not installed: that' >&2\nexit {NOT_INSTALLED}\n")
            python.chmod(0o755)
            with self.assertRaises(peers.Missing) as caught:
                peers.peer(None, python, "open3d_pairs", [], 10, Path(folder), Path(folder) / "poses.csv")
        self.assertEqual(str(caught.exception), "not installed: that")

    def test_a_failure_is_a_row_with_its_reason(self):
        with tempfile.TemporaryDirectory() as folder:
            python = Path(folder) / "python"
            python.write_text("#!/bin/sh\necho 'it broke' >&2\nexit 1\n")
            python.chmod(0o755)
            row = peers.peer(None, python, "open3d_pairs", [], 10, Path(folder), Path(folder) / "poses.csv")
        self.assertEqual(row, {"skipped": "failed: it broke"})


class Kept(unittest.TestCase):
    def test_a_measurement_is_repeated_only_for_another_key(self):
        calls = []
        with tempfile.TemporaryDirectory() as folder:
            def work():
                calls.append(1)
                return {"n": len(calls)}
            first = runner.kept(Path(folder), "a", work)
            again = runner.kept(Path(folder), "a", work)
            other = runner.kept(Path(folder), "b", work)
        self.assertEqual((first, again, other), ({"n": 1}, {"n": 1}, {"n": 2}))


if __name__ == "__main__":
    unittest.main()

"""polar batch: data sets in three conditions, one of them broken, killed and continued."""
import csv
import json
import os
import signal
import subprocess
import time
import unittest

from harness import POLAR, PolarCase

BATCH = """
defaults:
  registration: {starts: [imaged], symmetry: none}
  expert:  # coarse: seconds count here, not degrees
    anneal: {rotations: 512}
    proposals: {most_proposals: 0}
    refine: {rotations: 576}
    verdict: {draws: 1}
  output: {formats: [hdf5, csv], preview: false}
datasets: {folders: "data/*/*", input: localisations.csv}
bootstrap: {draws: 1000}
output: {directory: batch}
"""


def write_batch(case):
    """Data in the folder of a test: `case.config`, and `case.broken`, a table that should hold `case.table`."""
    # As few particles as still hold a structure: what is tested is the batch.
    simulation = case.write("simulation.yaml", "simulation: {particles: 12, orientation: in_plane, tilt_std_deg: 5,"
                            " blinks: poisson, blinks_mean: 6, sigma_xy_nm: 3, cramer_rao: false}\n")
    for labelled in (50, 70, 90):
        for cell in range(2):
            case.ok("simulate", simulation, "--output", f"data/labelled_{labelled}/cell_{cell}",
                    "--set", f"simulation.seed={labelled + cell}",
                    "--set", f"simulation.labelling_efficiency={labelled / 100}")
    case.broken = case.folder / "data/labelled_70/cell_1/localisations.csv"
    case.table = case.broken.read_text()
    case.broken.write_text("x,y\n1,2\n3\n")
    case.config = case.write("batch.yaml", BATCH)


class Batch(PolarCase):
    def setUp(self):
        super().setUp()
        write_batch(self)

    def rows(self, name="summary.csv"):
        with open(self.folder / "batch" / name, newline="") as table:
            return list(csv.DictReader(table))

    def test_killed_and_continued_to_the_bits_of_one_that_was_not(self):
        done = self.polar("batch", self.config, "--output", "whole")
        self.assertEqual(done.returncode, 1, done.stderr)
        process = subprocess.Popen([POLAR, "batch", self.config, "--quiet"], cwd=self.folder)
        while process.poll() is None and len(list((self.folder / "batch").glob("*/summary.json"))) < 2:
            time.sleep(0.01)
        process.send_signal(signal.SIGKILL)
        self.assertEqual(process.wait(), -signal.SIGKILL)
        finished = {path.parent.name: path.stat().st_mtime_ns
                    for path in (self.folder / "batch").glob("*/summary.json")}
        self.assertLess(len(finished), 5)
        time.sleep(0.2)  # the data set that it was at dies with it
        done = self.polar("batch", self.config, "--jobs", "2")
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("failed       labelled_70_cell_1: ", done.stdout)
        states = {row["name"]: row["state"] for row in self.rows()}
        self.assertEqual(len(states), 6)
        self.assertEqual({name for name, state in states.items() if state == "kept"}, set(finished))
        self.assertEqual([name for name, state in states.items() if state == "failed"], ["labelled_70_cell_1"])
        for path in (self.folder / "whole").glob("*/*.csv"):
            self.assertEqual((self.folder / "batch" / path.relative_to(self.folder / "whole")).read_bytes(),
                             path.read_bytes(), path)
        for name, changed in finished.items():
            self.assertEqual((self.folder / "batch" / name / "summary.json").stat().st_mtime_ns, changed)
        self.compare_conditions()
        self.mend()

    def compare_conditions(self):
        means = {(row["measure"], row["condition"], row["minus"]): row for row in self.rows("conditions.csv")}
        row = means["localisations_per_particle", "labelled_90", "labelled_50"]
        self.assertEqual((row["datasets"], row["minus_datasets"]), ("2", "2"))
        self.assertGreater(float(row["low"]), 0)  # nearly twice the labels
        self.assertEqual(means["accepted_share", "labelled_70", ""]["datasets"], "1")

    def mend(self):
        self.broken.write_text(self.table)
        self.ok("batch", self.config)
        self.assertEqual({row["state"] for row in self.rows()}, {"kept", "done"})
        self.ok("batch", self.config)
        self.assertEqual({row["state"] for row in self.rows()}, {"kept"})

    def test_signals_end_it_cleanly_and_faults_are_one_line(self):
        process = subprocess.Popen([POLAR, "batch", self.config, "--quiet"], cwd=self.folder, stderr=subprocess.PIPE)
        while process.poll() is None and not list((self.folder / "batch").glob("*/.polar.lock")):
            time.sleep(0.01)
        process.send_signal(signal.SIGTERM)
        _, errors = process.communicate(timeout=60)
        self.assertEqual((process.returncode, errors), (128 + signal.SIGTERM, b""))
        self.assertEqual(list((self.folder / "batch").glob("*/.polar.lock")), [])
        self.assertIn("stopped", {row["state"] for row in self.rows()} | {"stopped"})
        self.fails(2, "--only cell_9: no such data set: did you mean", "batch", self.config, "--only", "cell_9")
        self.fails(2, "unknown key 'registration.sede'", "batch", self.config, "--set", "registration.sede=1")
        self.fails(2, "--partition requires --slurm", "batch", self.config, "--partition", "short")
        self.fails(2, "excludes", "batch", self.config, "--slurm", "--gather")
        self.fails(6, "sbatch: cannot be started", "batch", self.config, "--slurm", env={"PATH": "/nowhere"})
        script = self.ok("batch", self.config, "--slurm", "--print", "--set", "output.voxel_nm=2", env={"PATH": "/nowhere"})
        self.assertIn(f"batch {self.config} --output {self.folder}/batch --set=output.voxel_nm=2)", script)
        self.ok("batch", self.config, "--only", "labelled_90_cell_0", "--json-log")
        with open(self.folder / "batch/batch.json") as state:
            datasets = {d["name"]: d for d in json.load(state)["datasets"]}
        self.assertIn(datasets["labelled_90_cell_0"]["state"], ("done", "kept"))
        self.assertEqual(datasets["labelled_70_cell_1"]["exit_code"], 3 if datasets["labelled_70_cell_1"]["state"] == "failed" else 0)


if __name__ == "__main__":
    unittest.main()

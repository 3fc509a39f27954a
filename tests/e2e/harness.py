"""Runs the polar program in a folder of its own."""
import json
import os
import pathlib
import subprocess
import tempfile
import unittest

POLAR = os.environ.get("POLAR", "polar")
HEADER = "x [nm],y [nm],z [nm],uncertainty_x [nm],uncertainty_y [nm],uncertainty_z [nm],particle\n"
# Keys for tests that are not about what the engine finds: one start, coarse grids, few centres, all its stages.
QUICK = """
registration: {starts: [imaged], symmetry: none}
expert:
  anneal: {rotations: 300, sweeps: 8}
  proposals: {most_proposals: 0}
  refine: {noise_tries: 1, calibrations: 1, most_searches: 1, rotations: 500, basins: 2, fewest_centres: 32}
  verdict: {draws: 1}
"""
# Particles that such a run finds.
SMALL = "simulation: {particles: 6, blinks_mean: 3, labelling_efficiency: 1, cramer_rao: false}"


class PolarCase(unittest.TestCase):
    def setUp(self):
        self._folder = tempfile.TemporaryDirectory(prefix="polar-e2e-")
        self.folder = pathlib.Path(self._folder.name)
        self.addCleanup(self._folder.cleanup)

    def write(self, name, content):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        if isinstance(content, bytes):
            path.write_bytes(content)
        else:
            path.write_text(content)
        return path

    def polar(self, *arguments, env=None, **options):
        return subprocess.run([POLAR, *map(str, arguments)], cwd=self.folder, capture_output=True, text=True,
                              timeout=600, env={**os.environ, **(env or {})}, **options)

    def ok(self, *arguments, **options):
        done = self.polar(*arguments, **options)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def fails(self, code, part, *arguments, **options):
        """Exit code, one line on stderr that says `part`, nothing on stdout."""
        done = self.polar(*arguments, **options)
        self.assertEqual(done.returncode, code, done.stderr)
        errors = [line for line in done.stderr.splitlines() if line.startswith("error: ")]
        self.assertEqual(len(errors), 1, done.stderr)
        self.assertIn(part, errors[0])
        self.assertEqual(done.stdout, "")
        return done

    def simulate(self, text="", name="data"):
        config = self.write(name + ".yaml", text + f"\noutput: {{directory: {name}}}\n")
        self.ok("simulate", config)
        return self.folder / name

    def run_config(self, files="data/localisations.csv", more="", name="run.yaml"):
        return self.write(name, f"input: {{files: [{files}]}}\n{more}")

    def recall(self, result, truth, angle_deg):
        report = json.loads(self.ok("evaluate", result, "--truth", truth, "--angles", angle_deg, "--json"))
        return report["recall"][0]["recall_missing_as_wrong"], report

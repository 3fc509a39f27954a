"""registration.symmetry from the outside."""
import json
import unittest

from harness import PolarCase

PORES = "simulation: {particles: 60, blinks_mean: 8}"


class Symmetry(PolarCase):
    def result(self, symmetry, output):
        self.ok("run", "run.yaml", "--set", f"registration.symmetry={symmetry}",
                "--set", "output.frame=raw", "--output", output)
        return json.loads((self.folder / output / "summary.json").read_text())

    def test_pores_are_found_to_be_d8_and_gain_by_it(self):
        data = self.simulate(PORES)
        self.run_config()
        found = self.result("detect", "detected")
        self.assertEqual(found["symmetry"]["group"], "D8")
        self.assertFalse(found["symmetry"]["imposed"])
        self.assertIn("D8 found", "\n".join(found["text"]))
        self.result("none", "plain")
        poses = [(self.folder / name / "poses.csv").read_bytes() for name in ("detected", "plain")]
        self.assertEqual(*poses)  # detection only reports
        imposed = self.result("D8", "imposed")
        self.assertTrue(imposed["symmetry"]["imposed"])
        self.assertEqual(imposed["symmetry"]["centre_nm"], [0, 0, 0])
        self.assertEqual(len(imposed["symmetry"]["unit_share"]), 16)
        self.assertAlmostEqual(sum(imposed["symmetry"]["unit_share"]), 1)
        plain_recall, plain = self.recall("plain", data / "poses.csv", 10)
        recall, report = self.recall("imposed", data / "poses.csv", 10)
        self.assertGreaterEqual(recall, plain_recall - 0.01)
        # To a fiftieth: each median is over the particles that its run accepts.
        self.assertLessEqual(report["median_pair_deg"], 1.02 * plain["median_pair_deg"])

    def test_planar_rings_have_turns_in_the_plane_only(self):
        self.simulate("structure: {kind: ring}\n"
                      "simulation: {particles: 40, planar: true, orientation: in_plane, blinks_mean: 6, cramer_rao: false}")
        self.run_config()
        self.assertRegex(self.result("detect", "detected")["symmetry"]["group"], "^C")
        self.fails(2, "not a group of planar data", "run", "run.yaml", "--set", "registration.symmetry=D8")

    def test_unknown_groups_are_refused(self):
        self.simulate("simulation: {particles: 4, cramer_rao: false}")
        self.run_config()
        self.fails(2, "'C8x' is none of auto, none, detect", "run", "run.yaml", "--set", "registration.symmetry=C8x")


if __name__ == "__main__":
    unittest.main()

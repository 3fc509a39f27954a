import csv
import json

from harness import PolarCase

ORIGAMI = ("structure: {kind: tetrahedron}\n"
           "simulation: {particles: 12, blinks_mean: 20, sigma_xy_nm: [2, 4], labelling_efficiency: 1}")
SHORT = "registration: {method: latent, latent: {localisations: 64, rotations: 300, basins: 2, most_loops: 2}}\n"


class Latent(PolarCase):
    def test_ends_with_the_latent_optimum_and_the_usual_files(self):
        self.simulate(ORIGAMI)
        self.ok("run", self.run_config(more=SHORT))
        folder = self.folder / "results"
        with open(folder / "poses.csv") as table:
            rows = list(csv.DictReader(table))
        self.assertEqual(len(rows), 12)
        for row in rows:
            self.assertEqual(row["accepted"], "1", row)
            norm = sum(float(row[k]) ** 2 for k in ("qw", "qx", "qy", "qz"))
            self.assertAlmostEqual(norm, 1, places=5)
            self.assertGreater(float(row["rotation_std_deg"]), 0)
        summary = json.loads((folder / "summary.json").read_text())
        self.assertEqual(summary["starts"][0]["name"], "polar")
        self.assertIn(summary["rounds"], (1, 2))
        self.assertTrue((folder / "results.h5").exists())
        self.assertRegex(summary["weights_sha256"], "^[0-9a-f]{64}$")

    def test_missing_weights_are_a_usage_error_that_names_the_key(self):
        self.simulate(ORIGAMI)
        self.fails(2, "registration.weights", "run",
                   self.run_config(more="registration: {starts: [polar], weights: nowhere.h5}\n"))
        self.fails(2, "registration.latent.visibility", "run",
                   self.run_config(more="registration: {latent: {visibility: 3}}\n"))
        self.fails(2, "did you mean 'registration.latent.basins'", "run",
                   self.run_config(more="registration: {latent: {basin: 3}}\n"))

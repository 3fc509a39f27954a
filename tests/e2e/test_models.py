"""Geometric models and modes: what polar fit and polar modes write, on simulated and on real localisations."""
import csv
import json
import pathlib
import unittest

from harness import PolarCase

FORMATS = pathlib.Path(__file__).resolve().parents[3] / "shared/data/formats"
PORES = "simulation: {particles: 24, blinks_mean: 4, sigma_z_factor: [1, 1], cramer_rao: false%s}"


def rows(path):
    with path.open() as table:
        return list(csv.DictReader(table))


class Fit(PolarCase):
    def test_pores_with_known_poses(self):
        data = self.simulate(PORES % ", radius_std_nm: 4")
        said = self.ok("fit", data / "localisations.csv", "--poses", data / "poses.csv", "--model", "two_rings",
                       "--output", "fit")
        self.assertIn("radius", said)
        table = rows(self.folder / "fit/fit.csv")
        self.assertEqual([r["particle"] for r in table[:2]], ["superparticle", "1"])
        self.assertEqual(len(table), 25)
        changes = {r["particle"]: float(r["radius_change_nm"]) for r in rows(data / "shapes.csv")}
        inside = sum(abs(float(r["radius_nm"]) - 53.5 - changes[r["particle"]]) < 1.96 * float(r["radius_std_nm"])
                     for r in table[1:])
        self.assertGreaterEqual(inside, 19)  # of 24 at 95 %: fewer happen once in 500 times
        report = json.loads((self.folder / "fit/fit.json").read_text())
        own = report["evidence"]["gain_of_each_particle"]
        self.assertGreater(own["gain"], 2 * own["standard_error"])  # the pores do differ
        self.assertEqual((self.folder / "fit/fit.png").read_bytes()[:4], b"\x89PNG")
        self.assertEqual(len(rows(self.folder / "fit/model.csv")[0]), 4)
        self.fails(4, "is not empty", "fit", data / "localisations.csv", "--poses", data / "poses.csv", "--model",
                   "two_rings", "--output", "fit")

    def test_a_result(self):
        data = self.simulate("simulation: {particles: 12, blinks_mean: 8, sigma_xy_nm: [2, 4], cramer_rao: false}")
        config = self.run_config(more="registration: {symmetry: D8, starts: [imaged]}\n"
                                      "output: {formats: [hdf5], preview: false, report: false}\n"
                                      "expert: {proposals: {most_proposals: 0}, verdict: {draws: 1}}\n")
        self.ok("run", config, "--set", f"registration.initial_poses={data / 'poses.csv'}")
        self.ok("fit", "results", "--model", "nuclear_pore")
        report = json.loads((self.folder / "results/fit_nuclear_pore/fit.json").read_text())
        radius = report["superparticle"]["parameters"]["radius"]
        self.assertLess(abs(radius["value"] - 53.5), 4 * radius["std"])
        self.ok("fit", "results/results.h5", "--model", "ring", "--output", "ring")
        free = json.loads((self.folder / "ring/fit.json").read_text())["evidence"]["gain_of_free_template"]
        self.assertGreater(free["gain"], 5 * free["standard_error"])  # one ring is not enough for two
        self.assertIn("not above noise", self.ok("modes", "results", "--modes", 1, "--draws", 3))
        self.fails(2, "a result has its own", "fit", "results", "--model", "ring", "--poses", data / "poses.csv")
        self.fails(2, "a result has been read", "fit", "results", "--model", "ring", "--set", "input.unit=um")

    def test_faults(self):
        data = self.simulate("simulation: {particles: 2, cramer_rao: false}")
        table = data / "localisations.csv"
        self.fails(2, "neither a shipped model nor a file: shipped: cylinder", "fit", table, "--model", "tube")
        self.write("m.yaml", "name: m\nparameters: {}\nparts:\n  - ring: {radius: 2 * r}\n")
        self.fails(2, "m.yaml:4: parts[1].ring.radius is no formula", "fit", table, "--model", "m.yaml")
        self.fails(2, "--hold size: no such parameter: known: width", "fit", table, "--model", "ring", "--hold", "size")
        self.fails(4, "none.csv", "fit", "none.csv", "--model", "ring")
        self.fails(2, "needs sites", "fit", table, "--model", "sites")
        self.write("other.csv", (data / "poses.csv").read_text().replace("\n1,", "\na,").replace("\n2,", "\nb,"))
        self.fails(3, "has no pose of any particle", "fit", table, "--model", "ring", "--poses", "other.csv")

    def test_a_model_of_ones_own(self):
        data = self.simulate("structure: {kind: ring}\nsimulation: {particles: 2, blinks_mean: 20, cramer_rao: false}")
        self.write("eight.yaml", "name: eight\nparameters:\n"
                   "  size: {unit: nm, start: 2 * extent, bounds: [1, 500], about: diameter}\n"
                   "parts:\n  - ring: {radius: size / 2, units: 8}\n")
        self.ok("fit", data / "localisations.csv", "--model", "eight.yaml", "--output", "eight")
        for row in rows(self.folder / "eight/fit.csv"):
            self.assertLess(abs(float(row["size_nm"]) - 100), 5 * float(row["size_std_nm"]))


@unittest.skipUnless(FORMATS.is_dir(), "development data is not there")
class LocMoFit(PolarCase):
    """Files of another program's examples, made with a radius of 50 nm, rings 50 nm apart."""
    def fit(self, name, model):
        self.ok("fit", FORMATS / f"smap_locmofit_{name}.csv", "--model", model, "--output", model)
        return rows(self.folder / model / "fit.csv")[0]

    def near(self, row, name, truth):
        self.assertLess(abs(float(row[name + "_nm"]) - truth), 4 * float(row[name + "_std_nm"]))

    def test_ring_and_pore(self):
        self.near(self.fit("example_ring_data", "ring"), "radius", 50)
        pore = self.fit("simulated_data_npc", "nuclear_pore")
        self.near(pore, "radius", 50)
        self.near(pore, "distance", 50)


class Modes(PolarCase):
    def test_radius_of_pores(self):
        data = self.simulate(PORES % ", radius_std_nm: 5, labelling_efficiency: 0.9")
        said = self.ok("modes", data / "localisations.csv", "--poses", data / "poses.csv", "--sites",
                       data / "sites.csv", "--modes", 2, "--draws", 3, "--output", "modes")
        self.assertIn("sites        32", said)
        first = rows(self.folder / "modes/modes.csv")[0]
        self.assertEqual(first["above_noise"], "1")
        self.assertGreater(float(first["radial_share"]), 0.8)
        scores = {r["particle"]: float(r["position_1"]) for r in rows(self.folder / "modes/scores.csv")}
        changes = {r["particle"]: float(r["radius_change_nm"]) for r in rows(data / "shapes.csv")}
        both = [(scores[p], changes[p]) for p in changes]
        mean = [sum(v) / len(both) for v in zip(*both)]
        cross, a, b = (sum((x[i] - mean[i]) * (x[j] - mean[j]) for x in both) for i, j in ((0, 1), (0, 0), (1, 1)))
        self.assertGreater(abs(cross) / (a * b) ** 0.5, 0.9)
        places = rows(self.folder / "modes/mode_sites.csv")
        self.assertEqual({r["score"] for r in places}, {"-2", "0", "2"})
        self.assertEqual((self.folder / "modes/mode_1.png").read_bytes()[:4], b"\x89PNG")
        self.fails(2, "is a table without poses", "modes", data / "localisations.csv")
        self.fails(2, "draws must be 1 to 1000", "modes", data / "localisations.csv", "--draws", 0)

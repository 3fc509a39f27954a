"""Two colours: the rings decide the poses, the centre is carried along, in one table, in two, or later."""
import csv
import json
import random
import unittest

from harness import QUICK, PolarCase

PORES = ("simulation: {particles: 40, orientation: in_plane, tilt_std_deg: 10, blinks_mean: 4, labelling_efficiency: 0.9,"
         " sigma_xy_nm: 4, cramer_rao: false}")
CENTRE_SIGMA_NM, CENTRE_LOCALISATIONS = 4, 12


def rotated_back(pose, point):
    """R^T (point - t) of a line of poses.csv."""
    w, x, y, z = (float(pose[k]) for k in ("qw", "qx", "qy", "qz"))
    r = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
         [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
         [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
    d = [point[i] - float(pose[k]) for i, k in enumerate(("tx_nm", "ty_nm", "tz_nm"))]
    return [sum(r[i][j] * d[i] for i in range(3)) for j in range(3)]


class Channels(PolarCase):
    """Poses by the rings alone; the centre of every pore, in the other colour, must come out at the centre."""
    def setUp(self):
        super().setUp()
        self.simulate(PORES)
        with open(self.folder / "data/localisations.csv", newline="") as table:
            self.rings = list(csv.DictReader(table))
        with open(self.folder / "data/poses.csv", newline="") as table:
            poses = list(csv.DictReader(table))
        draw = random.Random(5)
        self.centres = []
        for pose in poses:
            centre = rotated_back(pose, (0, 0, 0))
            for _ in range(CENTRE_LOCALISATIONS):
                row = {f"{axis} [nm]": f"{value + draw.gauss(0, CENTRE_SIGMA_NM):.4f}" for axis, value in zip("xyz", centre)}
                row.update({f"uncertainty_{axis} [nm]": CENTRE_SIGMA_NM for axis in "xyz"}, particle=pose["particle"])
                self.centres.append(row)

    def table(self, name, rows, more=()):
        columns = [f"{axis} [nm]" for axis in "xyz"] + [f"uncertainty_{axis} [nm]" for axis in "xyz"] + ["particle", *more]
        with open(self.folder / name, "w", newline="") as file:
            writer = csv.DictWriter(file, columns, extrasaction="ignore")
            writer.writeheader()
            writer.writerows(rows)

    def aligned(self, folder="results", **wanted):
        with open(self.folder / folder / "aligned.csv", newline="") as table:
            return [row for row in csv.DictReader(table) if all(row[k] == v for k, v in wanted.items())]

    def centroid(self, rows):
        return [sum(float(row[f"{axis} [nm]"]) for row in rows) / len(rows) for axis in "xyz"]

    def assertSamePlace(self, a, b, tolerance_nm):
        for x, y in zip(a, b):
            self.assertLess(abs(x - y), tolerance_nm)

    def test_the_second_colour_is_where_it_should_be(self):
        both = [dict(row, channel=1) for row in self.rings] + [dict(row, channel=2) for row in self.centres]
        self.table("both.csv", both, ["channel"])
        more = QUICK.replace("symmetry: none", "symmetry: D8") + "output: {formats: [hdf5, csv, vtkhdf, tiff, sites]}\n"
        self.write("run.yaml", "input: {files: both.csv, channel: {column: channel, register: [1]}}\n" + more)
        self.ok("run", "run.yaml")
        first, second = self.aligned(channel="1"), self.aligned(channel="2")
        self.assertEqual(len(second) % CENTRE_LOCALISATIONS, 0)
        self.assertGreater(len(second), 30 * CENTRE_LOCALISATIONS)
        self.assertGreater(len(first), len(second))
        self.assertSamePlace(self.centroid(second), (0, 0, 0), 1)  # where the axes of the rings' symmetry meet
        # Sites of the record later are those of the run: the carried colour has none.
        sites = (self.folder / "results/sites.csv").read_bytes()
        (self.folder / "later").mkdir()
        self.ok("export", "results", "--to", "sites", "--output", "later")
        self.assertEqual((self.folder / "later/sites.csv").read_bytes(), sites)
        self.assertGreater(len(sites.splitlines()), 8)
        # The centre takes no part: without it the poses are the same bits.
        self.table("rings.csv", self.rings)
        self.write("rings.yaml", "input: {files: rings.csv}\n" + more)
        self.ok("run", "rings.yaml", "--output", "rings_only")
        self.assertEqual(self.poses("results"), self.poses("rings_only"))
        self.assertEqual(self.labelling("results"), self.labelling("rings_only"))
        self.assertGreater(self.labelling("results")["sites"], 0)
        # One file a channel says the same.
        self.table("centres.csv", self.centres)
        self.write("files.yaml", "input: {files: [rings.csv, centres.csv], channel: {per_file: true}}\n" + more)
        self.ok("run", "files.yaml", "--output", "files")
        self.assertEqual(self.poses("results"), self.poses("files"))
        self.assertEqual([row["x [nm]"] for row in self.aligned("files", file_channel="centres")],
                         [row["x [nm]"] for row in second])
        # Another table, later.
        self.ok("apply", "rings_only", "centres.csv", "--output", "applied")
        self.assertEqual([row["x [nm]"] for row in self.aligned("applied")], [row["x [nm]"] for row in second])
        self.assertTrue((self.folder / "results/preview.png").exists())

    def labelling(self, folder):
        return json.loads((self.folder / folder / "summary.json").read_text())["labelling"]

    def poses(self, folder):
        names = ("particle", "qw", "qx", "qy", "qz", "tx_nm", "ty_nm", "tz_nm", "accepted")
        with open(self.folder / folder / "poses.csv", newline="") as table:
            return [[row[name] for name in names] for row in csv.DictReader(table)]

    def test_faults_of_apply_are_one_line(self):
        self.table("others.csv", [dict(row, particle="x" + row["particle"]) for row in self.centres])
        self.fails(3, "none of its particles ('x", "apply", "data/poses.csv", "others.csv", "--output", "a")
        self.fails(3, "data/localisations.csv", "apply", "data/localisations.csv", "others.csv", "--output", "b")
        self.table("centres.csv", self.centres)
        self.ok("apply", "data/poses.csv", "centres.csv", "--output", "c", "--to", "csv,mrc")
        self.assertSamePlace(self.centroid(self.aligned("c")), (0, 0, 0), 1)
        self.fails(4, "is not empty", "apply", "data/poses.csv", "centres.csv", "--output", "c")
        self.ok("apply", "data/poses.csv", "centres.csv", "--output", "c", "--overwrite")
        self.assertFalse((self.folder / "c/template.mrc").exists())


if __name__ == "__main__":
    unittest.main()

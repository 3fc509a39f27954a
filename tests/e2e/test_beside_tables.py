"""What goes with tables and is read as they are: centres of picks, structures to simulate, poses."""
import csv
import json

from test_tables import FAST, NAMES, TableCase, shape, text


class Picks(TableCase):
    def setUp(self):
        super().setUp()
        self.rows = shape(5, 40)
        self.centres = [(1000 * p, 1500) for p in range(1, 6)]
        self.write("fov.csv", text(self.rows, [n.replace("nm", "px") for n in NAMES], columns=[0, 1, 2, 3, 4, 5, 7],
                                   digits=(5,) * 6))

    def picked(self, centres, radius=120, pixel=", pixel_size_nm: 100"):
        return self.input("[fov.csv]", f", particles: picked{pixel}, pick: {{radius_nm: {radius}, centres: {centres}}}")

    def test_centres_obey_units(self):
        self.write("px.csv", "x,y\n" + "".join(f"{x / 100},{y / 100}\n" for x, y in self.centres))
        self.write("um.csv", "x [um],y [um]\n" + "".join(f"{x / 1000},{y / 1000}\n" for x, y in self.centres))
        self.write("regions.yaml", "Centers:\n" + "".join(f"- - {x / 100}\n  - {y / 100}\n" for x, y in self.centres) +
                   "Diameter: 2.4\nShape: Circle\n")
        self.write("flow.yaml", "Shape: Circle\nCenters: [" +
                   ",\n  ".join(f"[{x / 100}, {y / 100}]" for x, y in self.centres) + "]\n")
        for centres in ("px.csv", "um.csv", "regions.yaml", "flow.yaml"):
            with self.subTest(centres):
                report = self.said(self.picked(centres))
                self.assertEqual((report["particles"], report["localisations_per_particle"]["minimum"]), (5, 40))
        self.warned("the centres of the picks carry no unit: taken in the table's own, px = 100 nm",
                    self.said(self.picked("px.csv")))

    def test_picks_that_miss_or_cut_are_said(self):
        self.write("nm.csv", "x [nm],y [nm]\n" + "".join(f"{x + 50000},{y}\n" for x, y in self.centres))
        self.fails(3, "none of the 5 picks holds a localisation: the centres are at x 51000 to 55000 nm", "inspect",
                   self.picked("nm.csv"))
        self.write("px.csv", "x,y\n" + "".join(f"{x / 100},{y / 100}\n" for x, y in self.centres))
        self.warned("localisations go on right outside the radius of 40 nm", self.said(self.picked("px.csv", 40)))
        self.assertFalse(any("outside" in w for w in self.said(self.picked("px.csv"))["warnings"]))


class Structures(TableCase):
    """Structures to simulate are read as tables are."""
    WANTED = [(50.0, 0.0, -20.0), (20.0, 45.0, -20.0), (-30.0, 10.0, 40.0)]

    def sites(self, content):
        self.write("s.csv", content)
        self.write("s.yaml", "structure: {kind: file, file: s.csv}\nsimulation: {particles: 2, cramer_rao: false}\n"
                             "output: {directory: sim}\n")
        said = self.ok("simulate", "s.yaml", "--overwrite")
        with (self.folder / "sim/sites.csv").open() as table:
            return [[float(v) for v in row] for row in list(csv.reader(table))[1:]], said

    def test_every_spelling_is_one_structure(self):
        wanted, _ = self.sites("50,0,-20\n20,45,-20\n-30,10,40\n")
        rows = ["{},{},{}".format(*p) for p in self.WANTED]
        spellings = ("x,y,z\n" + "\n".join(rows), "id,x,y,z\n" + "\n".join(f"{i},{r}" for i, r in enumerate(rows)),
                     ",x,y,z\n" + "\n".join(f"{i},{r}" for i, r in enumerate(rows)),
                     "name,x,y,z\n" + "\n".join(f"s{i},{r}" for i, r in enumerate(rows)),
                     "z,y,x\n" + "\n".join(",".join(reversed(r.split(","))) for r in rows),
                     "x;y;z\n" + "\n".join(r.replace(",", ";").replace(".", ",") for r in rows),
                     "# sites of X\nx,y,z\n" + "\n".join(rows), "# x,y,z\n" + "\n".join(rows),
                     "x [A],y [A],z [A]\n" + "\n".join("{},{},{}".format(*(10 * v for v in p)) for p in self.WANTED),
                     "x [um],y [um],z [um]\n" + "\n".join("{},{},{}".format(*(v / 1000 for v in p)) for p in self.WANTED))
        for content in spellings:
            with self.subTest(content):
                got, _ = self.sites(content + "\n")
                self.assertEqual(len(got), 3)
                for a, b in zip(got, wanted):
                    for u, v in zip(a, b):
                        self.assertAlmostEqual(u, v, places=5)

    def test_without_z_it_is_flat_and_said(self):
        sites, said = self.sites("x,y\n50,0\n20,45\n")
        self.assertEqual([s[2] for s in sites], [0, 0])
        self.assertIn("has no z: the structure is flat", said)
        self.write("s.csv", "0,50,0,-20\n1,20,45,-20\n")
        self.fails(3, "has no header: give it one that names its columns", "simulate", "s.yaml", "--overwrite")
        self.write("s.csv", "x [px],y [px],z [px]\n5,0,-2\n2,4,-2\n")
        self.fails(3, "their size is not known: give it in nm", "simulate", "s.yaml", "--overwrite")


class Poses(TableCase):
    def test_a_truth_that_went_through_a_spreadsheet(self):
        rows = shape(5, 150)
        self.write("t.csv", text(rows))
        self.ok("run", self.input("[t.csv]", rest=FAST), "--threads", "1", "--quiet")
        poses = (self.folder / "results/poses.csv").read_text()
        lines = poses.splitlines()
        spellings = {"bom": "\ufeff" + poses, "semicolon": poses.replace(",", ";").replace(".", ","),
                     "float": "\n".join([lines[0]] + [line.replace(",", ".0,", 1) for line in lines[1:]]) + "\n",
                     "bool": poses.replace(",1,,", ",TRUE,,")}
        for name, content in spellings.items():
            with self.subTest(name):
                self.write("truth.csv", content)
                done = self.polar("evaluate", "results", "--truth", "truth.csv", "--json")
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertEqual(json.loads(done.stdout)["compared"], 5)
                self.assertEqual("matched as numbers" in done.stderr, name == "float")
        self.write("truth.csv", "\n".join([lines[0]] + ["p" + line for line in lines[1:]]) + "\n")
        self.fails(3, "ids are 'p1', ... in the truth and '1', ... in the estimate", "evaluate", "results", "--truth",
                   "truth.csv")

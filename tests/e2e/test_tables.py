"""Tables as users have them: one set of particles in many spellings, and spellings that mean something else."""
import csv
import gzip
import json
import os
import random
import shutil

from harness import QUICK, PolarCase

SITES = [(0, 0, 0), (60, 5, -10), (25, 50, 5), (-40, 30, 20), (-55, -20, -15), (-5, -60, 10), (45, -35, 25),
         (10, 20, 60), (-15, 15, -50)]
NAMES = ["x [nm]", "y [nm]", "z [nm]", "uncertainty_x [nm]", "uncertainty_y [nm]", "uncertainty_z [nm]", "particle",
         "frame", "intensity [photon]"]
FAST = QUICK.replace("[imaged]", "random").replace("sweeps: 8", "sweeps: 24") + "output: {formats: [hdf5, csv, picasso, thunderstorm]}\n"


def exact(value_nm):
    """The nearest number on a grid of picometres that is the same double whatever unit it is written in."""
    k = round(value_nm * 1000)
    while not all(float(f"{k}e-{digits}") * factor == k / 1000
                  for digits, factor in ((6, 1e3), (12, 1e9), (2, 0.1))):
        k += 1
    return k


def shape(particles=6, localisations=30, flat=False, seed=1):
    """Rows of integers in picometres (x, y, z, three sigmas), particle, frame, photons."""
    random_ = random.Random(seed)
    rows = []
    for particle in range(1, particles + 1):
        turn = [random_.gauss(0, 1) for _ in range(4)]
        if flat:
            turn = [turn[0], 0, 0, turn[3]]
        norm = sum(t * t for t in turn) ** 0.5
        w, a, b, c = (t / norm for t in turn)
        rotation = [[1 - 2 * (b * b + c * c), 2 * (a * b - w * c), 2 * (a * c + w * b)],
                    [2 * (a * b + w * c), 1 - 2 * (a * a + c * c), 2 * (b * c - w * a)],
                    [2 * (a * c - w * b), 2 * (b * c + w * a), 1 - 2 * (a * a + b * b)]]
        for _ in range(localisations):
            site = random_.choice(SITES)
            sigma = random_.uniform(3, 5)
            at = [sum(r * s for r, s in zip(row, site)) + random_.gauss(0, sigma) + offset
                  for row, offset in zip(rotation, (1000 * particle, 1500, 100))]
            if flat:
                at[2] = 0
            rows.append([exact(v) for v in (*at, sigma, sigma, 2 * sigma)] +
                        [particle, random_.randrange(1, 99999), random_.randrange(500, 5000)])
    return rows


def text(rows, names=NAMES, columns=range(9), delimiter=",", digits=(3,) * 6, comma=False, ids=str):
    """A table of some columns; `digits` is how far the decimal point of each length moves from picometres."""
    def number(value, shift):
        if not isinstance(value, int):
            return value
        sign, body = ("-" if value < 0 else ""), str(abs(value)).rjust(shift + 1, "0")
        return sign + body[:-shift] + ("," if comma else ".") + body[-shift:]
    lines = [delimiter.join(names[c] for c in columns)]
    for row in rows:
        cells = [number(v, d) for v, d in zip(row[:6], digits)] + [ids(row[6]), str(row[7]), str(row[8])]
        lines.append(delimiter.join(cells[c] for c in columns))
    return "\n".join(lines) + "\n"


def in_unit(unit, extra=()):
    return [n.replace("[nm]", f"[{unit}]") for n in NAMES[:6]] + list(extra or NAMES[6:])


class TableCase(PolarCase):
    def said(self, *arguments):
        """What inspect says of a table or a configuration, with the numbers of the used columns by name."""
        report = json.loads(self.ok("inspect", *arguments, "--json"))
        report["used"] = {c["name"]: (c["minimum"], c["median"], c["maximum"]) for c in report["columns"] if c["used"]}
        return report

    def warned(self, part, report):
        self.assertTrue(any(part in w for w in report["warnings"]), report["warnings"])

    def input(self, files, more="", name="c.yaml", rest=""):
        return self.write(name, f"input: {{files: {files}{more}}}\n{rest}")


class Spellings(TableCase):
    """One table, however it is written, gives the same poses bit by bit."""

    def poses(self, files, more="", drop=("particle",)):
        config = self.input(files, more, rest=FAST)
        self.ok("run", config, "--threads", "1", "--overwrite", "--quiet")
        with (self.folder / "results/poses.csv").open() as table:
            rows = list(csv.DictReader(table))
        return [[v for k, v in row.items() if k not in drop] for row in rows], [row["particle"] for row in rows]

    def test_units_orders_ids_decimals_and_files(self):
        rows = shape()
        self.write("plain.csv", text(rows))
        wanted, names = self.poses("[plain.csv]")
        self.assertEqual(names, [str(i) for i in range(1, 7)])
        self.assertTrue(all(row[2] == "1" for row in wanted), wanted)
        micro = ["X_(um)", "Y_(um)", "Z_(um)", "X_loc_error(um)", "Y_loc_error(um)", "Z_loc_error(um)", "particle",
                 "Frame", "photons"]
        spellings = {
            "um.csv": text(rows, micro, digits=(6,) * 6),
            "m.txt": text(rows, in_unit("meters"), delimiter="\t", digits=(12,) * 6),
            "angstrom.csv": text(rows, in_unit("\u00c5"), digits=(2,) * 6),
            "order.csv": "Made by hand\nDate: today\n\n" + text(rows, columns=[8, 6, 5, 2, 7, 1, 4, 0, 3]),
            "comma.csv": "sep=;\n" + text(rows, delimiter=";", comma=True),
            "ids.csv": "\ufeff# a comment\n" + text(rows, ids=lambda p: f'"cell {p}, left"'),
            "commented.txt": "# " + text(rows, delimiter="\t"),
        }
        for name, content in spellings.items():
            with self.subTest(name):
                self.write(name, content)
                got, names = self.poses(f"[{name}]")
                self.assertEqual(got, wanted)
        self.assertEqual(names, [str(i) for i in range(1, 7)])
        with self.subTest("mapped by bare names"):
            self.write("bare.csv", text(rows, ["A [um]", "B [nm]", "C [um]", "e1 [nm]", "e2 [um]", "e3 [um]", "who", "t", "n"],
                                        digits=(6, 3, 6, 3, 6, 6)))
            columns = ", ".join(f"{key}: {{name: {name}}}" for key, name in
                                zip(("x", "y", "z", "sigma_x", "sigma_y", "sigma_z", "particle"),
                                    ("A", "B", "C", "e1", "e2", "e3", "who")))
            self.assertEqual(self.poses("[bare.csv]", f", columns: {{{columns}}}")[0], wanted)
        with self.subTest("several files"):
            self.write("parts/a.csv", text(rows[:60]))
            self.write("parts/deep/er/b.csv", text(rows[60:], in_unit("um"), digits=(6,) * 6))
            got, names = self.poses("['parts/**/*.csv']")
            self.assertEqual(got, wanted)
            self.assertEqual(names, ["a:1", "a:2", "b:3", "b:4", "b:5", "b:6"])

    def test_flat_data_in_containers_with_z(self):
        rows = shape(flat=True)
        self.write("flat.csv", text(rows, columns=[0, 1, 3, 4, 6, 7, 8]))
        wanted, _ = self.poses("[flat.csv]")
        self.assertTrue(all(row[2] == "1" for row in wanted), wanted)
        for z, sigma_z in (("", "10"), ("nan", "10"), ("0", "0"), ("0", "NaN"), ("0", "inf"), ("350", "9"), ("NA", "")):
            with self.subTest(z=z, sigma_z=sigma_z):
                self.write("in3d.csv", text([[*r[:2], z, *r[3:5], sigma_z, *r[6:]] for r in rows]))
                got, _ = self.poses("[in3d.csv]")
                self.assertEqual(got, wanted)
        self.write("bumpy.csv", text([[*r[:2], 1000 * (i % 7), *r[3:]] for i, r in enumerate(rows)]))
        self.assertEqual(self.poses("[bumpy.csv]", ", planar: true")[0], wanted)
        report = self.said("in3d.csv")
        self.assertTrue(report["planar"])
        self.warned("is empty throughout: registered in the plane", report)


class Identifiers(TableCase):
    def result(self, ids, wanted=None):
        """Runs particles under these ids; they must come back as they are, everywhere."""
        rows = shape(len(ids), 24)
        for i, row in enumerate(rows[:50]):
            row[7] = 100000 * (i + 1)  # six digits and more, which many programs write as 1e+05
        self.write("t.csv", text(rows, ids=lambda p: ids[p - 1]))
        self.ok("run", self.input("[t.csv]", rest=FAST), "--threads", "1", "--overwrite", "--quiet")
        results = self.folder / "results"
        for name in ("poses.csv", "aligned.csv"):
            with (results / name).open() as table:
                found = list(dict.fromkeys(row["particle"] for row in csv.DictReader(table)))
            self.assertEqual(found, wanted or ids, name)
        back = self.said("results/aligned.csv")
        self.assertEqual(back["particles"], len(ids))
        with (results / "aligned.csv").open() as table:
            frames = [row["frame"] for row in csv.DictReader(table)]
        self.assertEqual(sorted(frames), sorted(str(row[7]) for row in rows))
        with (results / "aligned_particles.csv").open() as table:
            return [(row["group"], row["particle"]) for row in csv.DictReader(table)]

    def test_ids_are_text(self):
        groups = self.result(["1.1", "1.10", "1E3", "1000", "001", "0E8", "100000", "9912140633506421",
                              "9912140633506422", "a b"])
        self.assertEqual(groups[3], ("1000", "1000"))
        self.assertEqual(groups[6], ("100000", "100000"))
        self.assertEqual(len({g for g, _ in groups}), 10, "every particle has a group of its own")
        exported = self.polar("export", "results", "--to", "picasso")
        self.assertIn("aligned_particles.csv lists", exported.stderr)
        self.fails(3, "is the record of a run, not a table: write one from it", "inspect", "results/results.h5")
        self.assertEqual(self.said("results/aligned.hdf5")["particles"], 10)

    def test_ids_that_differ_in_spelling_only_are_said(self):
        self.write("t.csv", text(shape(2, 4), ids=lambda p: ("1.1", "1.10")[p - 1]))
        self.warned("'1.1' and '1.10' are different particles", self.said("t.csv"))

    def test_what_means_no_particle(self):
        rows = shape(9, 12)
        none = {1: "-1", 2: "-2", 3: "", 4: "nan", 5: "NA", 6: "None", 7: "noise"}
        self.write("t.csv", text(rows, ids=lambda p: none.get(p, str(p))))
        report = self.said(self.input("[t.csv]", ", unassigned_particle: [noise, -2]"))
        self.assertEqual((report["particles"], report["unassigned"]), (2, 7 * 12))
        self.warned("'-1' 12, '-2' 12", report)
        self.assertFalse(any("no effect" in w for w in report["warnings"]), report["warnings"])

    def test_a_giant_is_named(self):
        rows = shape(8, 12)
        noise = [[exact(300 * i), exact(40 * i), 0, 5000, 5000, 5000, 0, 1, 1] for i in range(150)]
        self.write("t.csv", text(noise + rows))
        self.warned("'0' (150 localisations", self.said("t.csv"))

    def test_a_row_of_no_particle_refuses_nothing(self):
        rows = shape(2, 12)
        good = text(rows)
        self.write("t.csv", good + "nan,oops,1,0,0,0,-1,1,1\n")
        self.assertEqual(self.said("t.csv")["localisations"], 24)
        self.write("t.csv", good + "nan,oops,1,0,0,0,2,1,1\n")
        self.fails(3, "t.csv:26:2", "inspect", "t.csv")


class Duplicates(TableCase):
    def test_equal_files_are_refused_by_name(self):
        content = text(shape(3, 12))
        self.write("a.csv", content)
        self.write("copy.csv", content)
        os.link(self.folder / "a.csv", self.folder / "hard.csv")
        os.symlink("a.csv", self.folder / "link.csv")
        with gzip.open(self.folder / "a.csv.gz", "wt") as packed:
            packed.write(content)
        for other in ("copy.csv", "hard.csv", "link.csv", "a.csv.gz"):
            self.fails(3, "holds the same as", "inspect", "a.csv", other)

    def test_repeated_rows_and_particles_are_counted(self):
        rows = shape(3, 12)
        self.write("twice.csv", text(rows) + text(rows))
        report = self.said("twice.csv")
        self.warned("36 rows equal an earlier row", report)
        self.warned("its header stands in it 2 times", report)
        self.write("renamed.csv", text(rows + [[*r[:6], r[6] + 100, *r[7:]] for r in rows]))
        self.warned("3 particles hold the localisations of an earlier one ('101' is '1' again)", self.said("renamed.csv"))
        self.assertFalse(any("equal" in w or "hold" in w for w in self.said_of(rows)["warnings"]))

    def said_of(self, rows):
        self.write("once.csv", text(rows))
        return self.said("once.csv")


class Meaning(TableCase):
    """What a table or a configuration says is what is read, or a line says why not."""

    def setUp(self):
        super().setUp()
        self.rows = shape(4, 12)
        self.write("t.csv", text(self.rows))
        self.plain = self.said("t.csv")

    def test_a_mapping_that_contradicts_the_header_is_said(self):
        report = self.said(self.input("[t.csv]", ", columns: {z: {name: z, unit: um}}"))
        self.warned("'z [nm]' is in nm by its header, but input.columns.z.unit says um", report)
        self.warned("is z in another unit? (z <- 'z [nm]' (um))", report)

    def test_sizes_that_cannot_be(self):
        self.write("a.csv", text(self.rows, [n.split(" [")[0] for n in NAMES]))
        self.write("b.csv", text(shape(4, 12, seed=2), [n.split(" [")[0] for n in NAMES], digits=(6,) * 6))
        report = self.said("a.csv", "b.csv")
        self.warned("are the files in different units?", report)
        self.write("s.csv", text(self.rows, digits=(3, 3, 3, 6, 6, 6)))
        self.warned("smaller than any microscope's: is it in the right unit? (sigma_x <- 'uncertainty_x [nm]' (nm))",
                    self.said("s.csv"))

    def test_keys_without_effect(self):
        report = self.said(self.input("[t.csv]", ", unit: um, pixel_size_nm: 130, sigma_kind: variance, lpz_unit: px, "
                                      "assumed_sigma_nm: 3, minflux_z_factor: 0.5, unassigned_particle: foo"))
        for key in ("unit: um", "pixel_size_nm: 130", "sigma_kind: variance", "lpz_unit: px", "assumed_sigma_nm: 3",
                    "minflux_z_factor: 0.5", "unassigned_particle: foo"):
            self.warned(f"input.{key} has no effect", report)
        self.assertEqual(report["used"], self.plain["used"])
        self.warned("which input.particles: one_per_file ignores", self.said("t.csv", "--one-per-file"))

    def test_every_word_for_no_particle_has_an_effect(self):
        report = self.said(self.input("[t.csv]", ", unassigned_particle: [4, foo]"))
        self.assertEqual(report["particles"], 3)
        self.warned("input.unassigned_particle: foo has no effect", report)
        self.assertFalse(any("unassigned_particle: 4" in w for w in report["warnings"]), report["warnings"])
        self.warned("which input.particles: picked ignores",
                    self.said(self.input("[t.csv]", ", particles: picked, pick: {radius_nm: 200}")))

    def test_a_text_table_of_picasso(self):
        names = ["x", "y", "z", "lpx", "lpy", "lpz", "group", "frame", "photons"]
        pixel = [[*(str(v / 1000 / 130) for v in r[:2]), r[2], *(str(v / 1000 / 130) for v in r[3:6]), *r[6:]]
                 for r in self.rows]
        self.write("p.csv", text(pixel, names))
        for more, z_unit in ((", pixel_size_nm: 130, lpz_unit: px", 1), (", pixel_size_nm: 130", 1 / 130)):
            report = self.said(self.input("[p.csv]", more))
            for name, factor in (("x", 1), ("z", 1), ("sigma_xy", 1), ("sigma_z", z_unit)):
                self.assertAlmostEqual(report["used"][name][1], factor * self.plain["used"][name][1], places=3)
        self.warned("the median of lpz is below 1.5 nm: is it in pixels? (input.lpz_unit: px)", report)
        report = self.said(self.input("[p.csv]", ", pixel_size_nm: 130, lpz_unit: px, unit: px"))
        self.assertAlmostEqual(report["used"]["z"][1], self.plain["used"]["z"][1], places=3)

    def test_exports_say_what_was_assumed(self):
        rows = [r[:6] + [r[6], r[7], r[8]] for r in shape(6, 30)]
        self.write("a.csv", text(rows, NAMES[:3] + ["uncertainty [nm]", "-", "-"] + NAMES[6:], columns=[0, 1, 2, 3, 6]))
        self.ok("run", self.input("[a.csv]", rest="registration: {starts: random}\noutput: {formats: [hdf5]}\n"),
                "--threads", "1", "--quiet")
        done = self.polar("export", "results", "--to", "csv,tiff", "--voxel-nm", "0.01")
        self.assertIn("has no axial uncertainty: twice the lateral one is assumed", done.stderr)
        self.assertIn("instead of 0.01 nm", done.stderr)

    def test_uncertainties_by_any_name(self):
        for names, variance in ((["x_err", "y_err", "z_err"], 0), (["error_x", "error_y", "error_z"], 0),
                                (["std x", "std y", "std z"], 0), (["CRLB_X", "CRLB_Y", "CRLB_Z"], 0),
                                (["X precision", "Y precision", "Z precision"], 0),
                                (["var-x-nm2", "var-y-nm2", "var-z-nm2"], 1),
                                (["x variance [nm^2]", "y variance [nm^2]", "z variance [nm^2]"], 1)):
            with self.subTest(names[0]):
                rows = [[*r[:3], *([str((v / 1000) ** 2) for v in r[3:6]] if variance else r[3:6]), *r[6:]]
                        for r in self.rows]
                self.write("u.csv", text(rows, NAMES[:3] + names + NAMES[6:]))
                report = self.said("u.csv")
                self.assertFalse(report["sigma_assumed"] or report["axial_sigma_assumed"])
                for name in ("sigma_xy", "sigma_z"):
                    self.assertAlmostEqual(report["used"][name][1], self.plain["used"][name][1], places=4)

    def test_an_uncertainty_wins_over_the_width_of_the_psf(self):
        rows = [[*r[:3], 135000, 142000, r[3], *r[6:]] for r in self.rows]
        self.write("u.csv", text(rows, NAMES[:3] + ["sigma_x [nm]", "sigma_y [nm]", "uncertainty [nm]"] + NAMES[6:]))
        report = self.said("u.csv")
        self.assertEqual(report["used"]["sigma_xy"], self.plain["used"]["sigma_xy"])
        self.warned("taken as the width of the PSF", report)
        self.warned("twice the lateral one is assumed", report)

    def test_two_variances_are_enough(self):
        rows = [[*r[:3], *(str((v / 1000) ** 2) for v in r[3:5]), "0", *r[6:]] for r in self.rows]
        self.write("u.csv", text(rows, NAMES[:3] + ["var_x [nm^2]", "var_y [nm^2]", "-"] + NAMES[6:], columns=[0, 1, 2, 3, 4, 6]))
        report = self.said("u.csv")
        self.assertTrue(report["axial_sigma_assumed"])
        self.assertAlmostEqual(report["used"]["sigma_z"][1], self.plain["used"]["sigma_z"][1], places=3)

    def test_untaken_uncertainties_are_named(self):
        self.write("u.csv", text(self.rows, NAMES[:3] + ["fwhm err a", "b error map", "c"] + NAMES[6:]))
        report = self.said("u.csv")
        self.warned("'fwhm err a', 'b error map': named like an uncertainty and not used", report)
        self.warned("10 nm is assumed", report)

    def test_kept_columns_never_refuse(self):
        for cells in (("", "blinky"), ("1", "CF568"), ("NA", "1.5"), ("1.5", "NA"), ("2024-01-02", "3"), ("True", "False")):
            with self.subTest(cells):
                lines = text(self.rows).splitlines()
                kept = [line + "," + cells[1 if i > 20 else 0] for i, line in enumerate(lines[1:])]
                self.write("k.csv", "\n".join([lines[0] + ",note", *kept]) + "\n")
                self.assertEqual(self.said("k.csv")["used"], self.plain["used"])

    def test_no_number_in_any_spelling(self):
        for word in ("", "NA", "nan", "NaN", "-1.#IND", "-nan(ind)", "None", "#N/A"):
            with self.subTest(word):
                self.write("n.csv", text(self.rows + [[*self.rows[0][:2], word, *self.rows[0][3:]]]))
                self.fails(3, "n.csv:50:3: position is not finite", "inspect", "n.csv")
                report = self.said(self.input("[n.csv]", ", drop_nonfinite: true"))
                self.assertEqual((report["localisations"], report["rejected"][0]["rows"]), (48, 1))

    def test_thousands_and_mixed_decimals_are_refused(self):
        self.write("n.csv", text([['"1,011.22"', *r[1:]] for r in self.rows]))
        self.fails(3, "has a separator of thousands", "inspect", "n.csv")
        self.write("n.csv", text([['"1,011"', *r[1:]] for r in self.rows]))
        self.fails(3, "with points and with commas", "inspect", "n.csv")

    def test_rows_of_units_and_names(self):
        names = [n.split(" [")[0] for n in NAMES]
        units = "um,um,um,um,um,um,,,photon\n"
        head, body = text(self.rows, names, digits=(6,) * 6).split("\n", 1)
        self.write("n.csv", head + "\n" + units + body)
        self.assertEqual(self.said("n.csv")["used"], self.plain["used"])

    def test_flat_files_do_not_mix_with_others(self):
        self.write("f.csv", text(shape(4, 12, flat=True)))
        self.fails(3, "f.csv: is flat (has no z, or one that says nothing) while '", "inspect", "t.csv", "f.csv")
        self.fails(3, "input.planar: true", "inspect", "f.csv", "t.csv")
        self.assertTrue(self.said(self.input("[t.csv, f.csv]", ", planar: true"))["planar"])

    def test_columns_are_merged_by_quantity(self):
        self.write("b.csv", text(shape(4, 12, seed=3), NAMES[:6] + ["particle", "Frame", "photons"]))
        kept = [c for c in self.said("t.csv", "b.csv")["columns"] if not c["used"]]
        self.assertEqual([(c["name"], c["values"]) for c in kept], [("frame", 96), ("intensity [photon]", 96)])

    def test_names_of_files_with_one_stem(self):
        self.write("cell.txt", text(shape(2, 150, seed=3)))
        self.write("t.csv", text(shape(4, 150)))
        shutil.move(self.folder / "t.csv", self.folder / "cell.csv")
        self.ok("run", self.input("[cell.csv, cell.txt]", rest=FAST), "--threads", "1", "--quiet")
        with (self.folder / "results/poses.csv").open() as table:
            names = [row["particle"] for row in csv.DictReader(table)]
        self.assertEqual(names, ["cell.csv:1", "cell.csv:2", "cell.csv:3", "cell.csv:4", "cell.txt:1", "cell.txt:2"])

    def test_a_file_without_particles_among_others_is_named(self):
        self.write("b.csv", text(shape(4, 12, seed=3), columns=[0, 1, 2, 3, 4, 5, 7]))
        self.fails(3, "b.csv: no column says which localisation belongs to which particle", "inspect", "t.csv", "b.csv")

    def test_nothing_left_says_why(self):
        self.write("n.csv", text([["nan", *r[1:]] for r in self.rows]))
        config = self.input("[n.csv]", ", drop_nonfinite: true")
        self.fails(3, "no localisation is left: 48 rows left out: position is not finite", "run", config)
        self.assertIn("polar run would not start: ", self.ok("inspect", config))
        self.assertIn("polar run would start: 4 particles", self.ok("inspect", "t.csv"))

    def test_patterns_say_what_they_matched(self):
        for name in ("cells/a.csv", "cells/day1/b.csv", "cells/day1/x/c.csv", "cells/day2/y/d.CSV", "[1]/e.csv"):
            self.write(name, text(shape(2, 12, seed=len(name) + ord(name[-5]))))
        said = self.ok("inspect", self.input("['cells/**/*.csv', '[1]/*.csv']"))
        self.assertIn("cells/**/*.csv: 3 files (not ", said)
        self.assertIn("[1]/*.csv: 1 file\n", said)
        self.fails(3, "folders are separated by /", "inspect", self.input("['C:\\data\\t.csv']"))

    def test_text_that_is_no_yaml_says_what_to_do(self):
        self.fails(2, "a backslash in double quotes", "inspect", self.write("b.yaml", 'input: {files: ["C:\\Users\\t.csv"]}\n'))
        self.fails(2, "Decimals follow a point, not a comma", "inspect",
                   self.write("b.yaml", "input: {files: [t.csv], pixel_size_nm: 0,13}\n"))
        self.fails(2, "input.columns.id: is not one of x, y, z,", "inspect",
                   self.write("b.yaml", "input: {files: [t.csv], columns: {id: {name: particle}}}\n"))
        self.fails(2, "YAML is indented with blanks", "inspect", self.write("b.yaml", "input:\n\tfiles: [t.csv]\n"))
        self.ok("inspect", self.write("b.yaml", "\ufeffinput: {files: [t.csv]}\n"))

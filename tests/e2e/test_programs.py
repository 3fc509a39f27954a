"""What a run writes, opened by the programs it is written for. A program that is not installed skips its tests."""
import csv
import json
import os
import pathlib
import subprocess
import unittest

from harness import QUICK, SMALL, PolarCase

ALL = "output: {formats: [hdf5, vtkhdf, csv, tiff, ply, picasso, thunderstorm, mrc, star]}\n" + QUICK


def program(variable, what):
    """Skips a test class where the program that `variable` names is not installed."""
    return unittest.skipUnless(os.environ.get(variable), f"{what} is not installed")


class ProgramCase(PolarCase):
    """The tests of a class read one and the same run."""
    @classmethod
    def setUpClass(cls):
        cls.made = PolarCase()
        cls.made.setUp()
        cls.addClassCleanup(cls.made.doCleanups)
        cls.made.simulate(SMALL)
        cls.made.ok("run", cls.made.run_config(more=ALL))

    def setUp(self):
        self.folder = self.made.folder
        self.results = self.folder / "results"
        with (self.results / "aligned.csv").open() as table:
            self.aligned = list(csv.DictReader(table))

    def column(self, name):
        return [float(row[name]) for row in self.aligned]

    def output_of(self, command):
        done = subprocess.run(list(map(str, command)), cwd=self.folder, capture_output=True, text=True, timeout=240)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def python(self, variable, script):
        """What the script prints last, as JSON."""
        printed = self.output_of([os.environ[variable], self.write("script.py", script)])
        return json.loads(printed.splitlines()[-1])

    def assertAllClose(self, got, wanted, tolerance):
        self.assertEqual(len(got), len(wanted))
        for a, b in zip(got, wanted):
            self.assertLessEqual(abs(a - b), tolerance)


# Everything in one process, which takes seconds to start.
PARAVIEW = """
import json
from paraview.simple import OpenDataFile
from paraview.servermanager import Fetch

def points():
    data = Fetch(OpenDataFile("results/aligned.hdf"))
    arrays = data.GetPointData()
    names = range(arrays.GetNumberOfArrays())
    return {"points": data.GetNumberOfPoints(), "cells": data.GetNumberOfCells(), "bounds": data.GetBounds(),
            "range": {arrays.GetArrayName(i): arrays.GetArray(i).GetRange() for i in names},
            "components": {arrays.GetArrayName(i): arrays.GetArray(i).GetNumberOfComponents() for i in names}}

def density():
    data = Fetch(OpenDataFile("results/template.hdf"))
    arrays = data.GetPointData()
    values = arrays.GetArray("density")
    n = values.GetNumberOfTuples()
    return {"size": data.GetDimensions(), "voxel": data.GetSpacing(), "origin": data.GetOrigin(),
            "arrays": [arrays.GetArrayName(i) for i in range(arrays.GetNumberOfArrays())],
            "range": values.GetRange(), "mean": sum(values.GetValue(i) for i in range(n)) / n}

def ply():
    data = Fetch(OpenDataFile("results/aligned.ply"))
    return {"points": data.GetNumberOfPoints(), "bounds": data.GetBounds()}

print(json.dumps({"points": points(), "density": density(), "ply": ply()}))
"""


@program("PVPYTHON", "ParaView (pvpython)")
class ParaView(ProgramCase):
    loaded = None

    def setUp(self):
        super().setUp()
        if ParaView.loaded is None:
            ParaView.loaded = self.python("PVPYTHON", PARAVIEW)

    def bounds(self):
        return [f(self.column(f"{axis} [nm]")) for axis in "xyz" for f in (min, max)]

    def test_points_have_counts_bounds_and_every_column(self):
        loaded = self.loaded["points"]
        self.assertEqual((loaded["points"], loaded["cells"]), (len(self.aligned), len(self.aligned)))
        self.assertAllClose(loaded["bounds"], self.bounds(), 1e-4)  # the decimals of the CSV
        self.assertEqual(loaded["components"]["covariance_xx_xy_xz_yy_yz_zz_nm2"], 6)
        variance = self.column("sigma_zz [nm^2]")
        self.assertAllClose(loaded["range"]["sigma_z_nm"], [min(variance) ** 0.5, max(variance) ** 0.5], 1e-3)
        for name in ("frame", "intensity [photon]"):
            self.assertAllClose(loaded["range"][name], [min(self.column(name)), max(self.column(name))], 1e-9)
        self.assertEqual(loaded["range"]["particle"], [0, 5])

    def test_density_has_size_spacing_and_mass(self):
        loaded = self.loaded["density"]
        self.assertEqual(loaded["arrays"], ["density"])
        self.assertEqual(loaded["range"][0], 0)
        voxel = loaded["voxel"][0]
        self.assertEqual(loaded["voxel"], [voxel] * 3)
        voxels = loaded["size"][0] * loaded["size"][1] * loaded["size"][2]
        mass = loaded["mean"] * voxels * voxel ** 3
        self.assertLess(mass, len(self.aligned))  # the box cuts off the tails of the outermost
        self.assertGreater(mass, 0.9 * len(self.aligned))

    def test_ply_has_the_points(self):
        loaded = self.loaded["ply"]
        self.assertEqual(loaded["points"], len(self.aligned))
        self.assertAllClose(loaded["bounds"], self.bounds(), 1e-4)


# open() would want menus, which need a display; the plugin behind File > Import > URL does not.
MACRO = """
call("ij.IJ.runPlugIn", "ij.plugin.URLOpener", "file://" + getArgument());
getVoxelSize(width, height, depth, unit);
getDimensions(columns, rows, channels, slices, frames);
Stack.getStatistics(count, mean, least, most);
getMinAndMax(darkest, brightest);
x = 0; y = 0; z = 0;
toScaled(x, y, z);
print("template", columns, rows, slices, channels, frames, bitDepth(), unit, d2s(width, 9), d2s(height, 9),
      d2s(depth, 9), d2s(x, 6), d2s(y, 6), d2s(z, 6), d2s(least, -9), d2s(most, -9), d2s(mean, -9),
      d2s(darkest, -9), d2s(brightest, -9));
"""


# By h5py: size and first voxel's centre (x, y, z), voxel (nm), values. The assertions are Fiji's HDF5 import's.
TEMPLATE = """
import h5py, json
with h5py.File("results/template.hdf") as file:
    root = file["VTKHDF"]
    density = root["PointData/density"]
    extent = root.attrs["WholeExtent"]
    assert density.shape == (extent[5] + 1, extent[3] + 1, extent[1] + 1) and density.dtype == "float32"
    assert density.attrs["element_size_um"].dtype == "float32"
    assert abs(density.attrs["element_size_um"] * 1000 - root.attrs["Spacing"]).max() < 1e-6
    print(json.dumps([list(map(int, density.shape[::-1])), list(root.attrs["Origin"]), root.attrs["Spacing"][0],
                      [float(v) for v in density[:].ravel()]]))
"""
RECORD = """
import h5py, json
with h5py.File("results/results.h5") as file:
    def describe(name, item):
        if isinstance(item, h5py.Dataset) and name.split("/")[0] in ("poses", "template", "superparticle"):
            texts = item.dtype.kind == "S"
            assert texts or ("unit" in item.attrs and "meaning" in item.attrs), name
    file.visititems(describe)
    print(json.dumps({"version": int(file.attrs["format_version"]), "poses": file["poses/rotation"].shape,
                      "position": file["superparticle/position"][:].tolist(),
                      "configuration": file["run/configuration"][0].decode()}))
"""


@program("PICASSO_PYTHON", "h5py (build-tools/picasso)")
class H5py(ProgramCase):
    def test_record_describes_itself(self):
        record = self.python("PICASSO_PYTHON", RECORD)
        self.assertEqual(record["version"], 1)
        self.assertEqual(record["poses"], [6, 3, 3])
        self.assertIn("registration:", record["configuration"])
        for axis, name in enumerate(("x [nm]", "y [nm]", "z [nm]")):
            self.assertAllClose([x[axis] for x in record["position"]], self.column(name), 0.5001e-4)

    def test_density_has_the_layout_of_both_programs(self):
        size, _, voxel, values = self.python("PICASSO_PYTHON", TEMPLATE)
        self.assertEqual(len(values), size[0] * size[1] * size[2])
        self.assertGreater(sum(values) * voxel ** 3, 0.9 * len(self.aligned))


@program("IMAGEJ_JAR", "ImageJ (libij-java and a Java runtime)")
@program("PICASSO_PYTHON", "h5py (build-tools/picasso)")
class ImageJ(ProgramCase):
    def open(self):
        macro = self.write("open.ijm", MACRO)
        printed = self.output_of([os.environ["JAVA"], "-Djava.awt.headless=true", "-cp", os.environ["IMAGEJ_JAR"],
                                  "ij.ImageJ", "-batch", macro, self.results / "template.tif"])
        lines = [line.split() for line in printed.splitlines() if line.startswith("template ")]
        self.assertEqual(len(lines), 1, printed)
        return lines[0][1:]

    def test_stack_is_the_density_calibrated_in_nm(self):
        columns, rows, slices, channels, frames, bits, unit, *numbers = self.open()
        width, height, depth, x, y, z, least, most, mean, darkest, brightest = map(float, numbers)
        size, first, voxel, values = self.python("PICASSO_PYTHON", TEMPLATE)
        self.assertEqual([int(columns), int(rows), int(slices)], size)
        self.assertEqual((channels, frames, bits, unit), ("1", "1", "32", "nm"))
        self.assertAllClose([width, height, depth], [voxel] * 3, 1e-6)
        self.assertAllClose([x, y, z], first, 1e-4)
        self.assertAllClose([least, most], [min(values), max(values)], 1e-8)
        self.assertAllClose([darkest, brightest], [least, most], 1e-8)
        self.assertAlmostEqual(mean, sum(values) / len(values), delta=1e-8)


# The macro as a user has it: with windows, so that it wants a display.
FIJI = """
runMacro("{macro}", "{results}");
lines = "";
titles = getList("image.titles");
for (i = 0; i < titles.length; i++) {{
  selectImage(titles[i]);
  getVoxelSize(width, height, depth, unit);
  getDimensions(columns, rows, channels, slices, frames);
  lines = lines + titles[i] + " " + columns + " " + rows + " " + slices + " " + unit + " " + d2s(width, 6) + " " + Overlay.size + "\\n";
}}
File.saveString(lines + getInfo("log"), "{said}");
run("Quit");
"""


@program("XVFB_RUN", "Xvfb (xvfb-run)")
@program("IMAGEJ_JAR", "ImageJ (libij-java and a Java runtime)")
@program("PICASSO_PYTHON", "h5py (build-tools/picasso)")
class FijiMacro(ProgramCase):
    def test_template_opens_calibrated_with_a_scale_bar(self):
        scripts = pathlib.Path(__file__).resolve().parents[2] / "scripts"
        said = self.folder / "said.txt"
        macro = self.write("fiji.ijm", FIJI.format(macro=scripts / "open_template.ijm", results=self.results, said=said))
        self.output_of([os.environ["XVFB_RUN"], "-a", os.environ["JAVA"], "-cp", os.environ["IMAGEJ_JAR"], "ij.ImageJ",
                        "-macro", macro])
        stack, projection, log = said.read_text().splitlines()[:3]
        size, _, voxel, _ = self.python("PICASSO_PYTHON", TEMPLATE)
        self.assertEqual(stack.split()[:5], ["template.tif", *map(str, size), "nm"])
        self.assertAlmostEqual(float(stack.split()[5]), voxel, delta=1e-4)
        self.assertEqual(projection.split()[:5], ["MAX_template.tif", str(size[0]), str(size[1]), "1", "nm"])
        self.assertGreater(int(projection.split()[6]), 0, "the scale bar")
        self.assertIn("channels: 1", log)


# What RELION itself says of the files: it counts particles, and reads a map's size and voxel.
@program("RELION_STAR", "RELION (relion_star_handler)")
class Relion(ProgramCase):
    def test_reads_optics_poses_and_maps(self):
        said = self.output_of([os.environ["RELION_STAR"], "--i", "results/poses.star", "--o", "read.star"])
        self.assertNotIn("could not read optics", said)
        read = (self.folder / "read.star").read_text()
        table = read[read.index("data_particles"):].splitlines()
        with (self.results / "poses.csv").open() as poses:
            accepted = [row["particle"] for row in csv.DictReader(poses) if row["accepted"] == "1"]
        self.assertEqual([line.split()[0] for line in table if len(line.split()) == 12], accepted)
        image = pathlib.Path(os.environ["RELION_STAR"]).with_name("relion_image_handler")
        said = self.output_of([image, "--i", "results/template.mrc", "--stats"])
        header = (self.results / "template.mrc").read_bytes()[:1024]
        size = [int.from_bytes(header[4 * k:4 * k + 4], "little") for k in range(3)]
        self.assertIn("= {} x {} x {} x 1".format(*size), said)
        self.assertIn("angpix = ", said)


# load_locs drops, without a word, rows that lie outside the image or hold a negative or no number.
PICASSO = """
import json
from picasso import io, lib
locs, info = io.load_locs("results/aligned.hdf5")
pixel = lib.get_from_metadata(info, "Pixelsize")
shift = [lib.get_from_metadata(info, f"Shift {axis} (nm)") for axis in "xy"]
print(json.dumps({"n": len(locs), "documents": len(info), "pixel": pixel, "shift": shift,
                  "x": (locs["x"] * pixel).tolist(), "z": locs["z"].tolist(), "lpz": locs["lpz"].tolist(),
                  "group": sorted(set(map(int, locs["group"]))), "photons": locs["photons"].tolist()}))
"""
PICASSO_THUNDERSTORM = """
import json
from picasso import io
locs, info = io.import_ts("results/aligned_thunderstorm.csv", 100.0)
locs = locs.sort_values(["frame", "photons"])
print(json.dumps({"n": len(locs), "x": (locs["x"] * 100.0).tolist(), "z": locs["z"].tolist(),
                  "lpx": (locs["lpx"] * 100.0).tolist(), "photons": locs["photons"].tolist()}))
"""


@program("PICASSO_PYTHON", "Picasso (build-tools/picasso)")
class Picasso(ProgramCase):
    def test_loader_keeps_every_localisation(self):
        loaded = self.python("PICASSO_PYTHON", PICASSO)
        self.assertEqual(loaded["n"], len(self.aligned))
        self.assertEqual(loaded["documents"], 2)
        self.assertEqual(loaded["pixel"], 130)
        self.assertAllClose([x - loaded["shift"][0] for x in loaded["x"]], self.column("x [nm]"), 2e-4)
        self.assertAllClose(loaded["z"], self.column("z [nm]"), 1e-4)
        self.assertAllClose(loaded["lpz"], [v ** 0.5 for v in self.column("sigma_zz [nm^2]")], 1e-3)
        self.assertEqual(loaded["group"], sorted({int(row["particle"]) for row in self.aligned}))
        self.assertEqual(loaded["photons"], self.column("intensity [photon]"))

    def test_its_thunderstorm_import_reads_ours(self):
        self.aligned.sort(key=lambda row: (int(row["frame"]), float(row["intensity [photon]"])))
        loaded = self.python("PICASSO_PYTHON", PICASSO_THUNDERSTORM)
        self.assertEqual(loaded["n"], len(self.aligned))
        self.assertAllClose(loaded["x"], self.column("x [nm]"), 2e-4)
        self.assertAllClose(loaded["z"], self.column("z [nm]"), 1e-4)
        lateral = [((a + b) / 2) ** 0.5 for a, b in zip(self.column("sigma_xx [nm^2]"), self.column("sigma_yy [nm^2]"))]
        self.assertAllClose(loaded["lpx"], lateral, 1e-3)
        self.assertEqual(loaded["photons"], self.column("intensity [photon]"))


READERS = """
import gemmi, json, mrcfile, numpy, starfile
crystal = gemmi.read_ccp4_map("results/template.mrc")
with mrcfile.open("results/template.mrc") as map:
    volume = {"valid": mrcfile.validate("results/template.mrc"), "shape": map.data.shape, "sum": float(map.data.sum(dtype=float)),
              "voxel": float(map.voxel_size.x), "origin": [float(map.header.origin[k]) for k in "xyz"], "volume": bool(map.is_volume()),
              "gemmi": float(abs(numpy.array(crystal.grid, copy=False).transpose(2, 1, 0) - map.data).max()),
              "spacing": list(crystal.grid.spacing)}
star = starfile.read("results/poses.star")
p = star["particles"]
out = {"map": volume, "pixel": float(star["optics"]["rlnImagePixelSize"].iloc[0]), "name": [str(n) for n in p["rlnTomoParticleName"]],
       "coordinate": p[["rlnCoordinateX", "rlnCoordinateY", "rlnCoordinateZ"]].values.tolist(),
       "angles": p[["rlnAngleRot", "rlnAngleTilt", "rlnAnglePsi"]].values.tolist()}
print(json.dumps(out))
"""


@program("READERS_PYTHON", "gemmi, mrcfile or starfile")
class MapsAndStars(ProgramCase):
    def test_mrcfile_and_starfile_read_what_was_written(self):
        read = self.python("READERS_PYTHON", READERS)
        volume = read["map"]
        self.assertTrue(volume["valid"] and volume["volume"])
        # A reader of crystals' maps, which has its own idea of axes, finds every voxel in its place.
        self.assertEqual(volume["gemmi"], 0)
        self.assertAllClose(volume["spacing"], 3 * [volume["voxel"]], 1e-3)
        # A map in ångström holds as many localisations as there are: density times the voxel's volume.
        self.assertLess(abs(volume["sum"] * (volume["voxel"] / 10) ** 3 / len(self.aligned) - 1), .05)
        for axis, origin, size in zip("xyz", volume["origin"], volume["shape"][::-1]):
            inside = [origin <= 10 * x <= origin + size * volume["voxel"] for x in self.column(f"{axis} [nm]")]
            self.assertGreater(sum(inside), .98 * len(inside))
        with (self.results / "poses.csv").open() as table:
            poses = [row for row in csv.DictReader(table) if row["accepted"] == "1"]
        self.assertEqual(read["name"], [row["particle"] for row in poses])
        self.assertEqual(read["pixel"], 10)  # coordinates are in nm
        for pose, at in zip(poses, read["coordinate"]):  # the template's origin, in the table
            w, v = float(pose["qw"]), [float(pose[k]) for k in ("qx", "qy", "qz")]
            cross = lambda a, b: [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
            turn = cross(v, at)
            moved = [x + 2 * w * t + 2 * c + float(pose[k])
                     for x, t, c, k in zip(at, turn, cross(v, turn), ("tx_nm", "ty_nm", "tz_nm"))]
            self.assertLess(max(map(abs, moved)), 1e-6)


MODULE = """
import json, sys
sys.path.insert(0, {scripts!r})
import polar_results
r = polar_results.load("results")
first = next(i for i, ok in enumerate(r.accepted) if ok)
rows = r.particle == first
table = [[float(v) for v in line.split(",")[:3]] for line in open("data/localisations.csv").readlines()[1:]
         if line.split(",")[6] == r.name[first]]
moved = r.template_from_view[first].apply(table)
map = polar_results.read_mrc("results/template.mrc")
print(json.dumps({{"names": r.name, "accepted": r.accepted.tolist(), "n": len(r.position_nm), "columns": list(r.columns),
                   "aligned": float(abs(moved - r.position_nm[rows]).max()), "particles": r.summary["particles"],
                   "back": float(abs(r.template_from_view[first].inverse().apply(moved) - table).max()),
                   "same": float(abs(map.density - r.template.density).max()), "voxel": [map.voxel_nm, r.template.voxel_nm],
                   "origin": float(abs(map.origin_nm - r.template.origin_nm).max()),
                   "halves": [h.density.shape for h in r.half_maps], "picture": polar_results.draw(r, "average.png")}}))
"""


@program("PICASSO_PYTHON", "NumPy, h5py and Matplotlib (with Picasso)")
class ResultsModule(ProgramCase):
    def test_arrays_are_the_result(self):
        self.ok("run", "run.yaml", "--overwrite", "--set", "output.resolution=halves")
        scripts = pathlib.Path(__file__).resolve().parents[2] / "scripts"
        read = self.python("PICASSO_PYTHON", MODULE.format(scripts=str(scripts)))
        with (self.results / "poses.csv").open() as table:
            poses = list(csv.DictReader(table))
        self.assertEqual(read["names"], [row["particle"] for row in poses])
        self.assertEqual(read["accepted"], [row["accepted"] == "1" for row in poses])
        self.assertEqual((read["particles"], read["n"]), (6, len(list(csv.DictReader((self.results / "aligned.csv").open())))))
        self.assertIn("frame", read["columns"])
        self.assertLess(max(read["aligned"], read["back"]), 1e-3)
        self.assertLess(read["same"], 1e-9)
        self.assertLess(max(abs(read["voxel"][0] - read["voxel"][1]), read["origin"]), 1e-3)
        self.assertIn(len(read["halves"]), (0, 2))  # half maps where both halves have a pose
        self.assertTrue((self.folder / "average.png").read_bytes().startswith(b"\x89PNG"))


LINK = """
import json, numpy
from picasso import io, postprocess
locs, info = io.load_locs({file!r})
linked = postprocess.link(locs, info, r_max={reach}, max_dark_time={dark}, remove_ambiguous_lengths=False)
pixel = 160
scaled = {{"x": linked["x"] * pixel, "y": linked["y"] * pixel, "sigma_xy": numpy.sqrt((linked["lpx"]**2 + linked["lpy"]**2) / 2) * pixel,
           "photons": linked["photons"], "bg": linked["bg"], "frame": linked["frame"], "merged": linked["n"]}}
out = {{}}
for name, values in scaled.items():
    v = numpy.sort(numpy.asarray(values, float))
    out[name] = [v[0], v[len(v) // 2], v[-1]]
print(json.dumps({{"n": len(linked), "columns": out}}))
"""
# Picasso's link takes one distance for all: the rule for uncertainties again, as simply as it can be said.
RULE = """
import h5py, json, numpy
locs = h5py.File({file!r})["locs"][:]
pixel = 160
value = {{name: locs[name].astype(float) for name in ("frame", "x", "y", "lpx", "lpy", "photons", "bg")}}
variance = (value["lpx"]**2 + value["lpy"]**2) / 2
in_frame = {{}}
for row, frame in enumerate(value["frame"]):
    in_frame.setdefault(int(frame), []).append(row)
free = numpy.ones(len(locs), bool)
chains = []
for frame in sorted(in_frame):
    for start in in_frame[frame]:
        if not free[start]:
            continue
        chain = []
        here = start
        while here is not None:
            chain.append(here)
            free[here] = False
            now, here = here, None
            for later in range(int(value["frame"][now]) + 1, int(value["frame"][now]) + {dark} + 2):
                near = [row for row in in_frame.get(later, ()) if free[row]
                        and (value["x"][row] - value["x"][now])**2 + (value["y"][row] - value["y"][now])**2
                        <= {sigmas}**2 * (variance[row] + variance[now])]
                if near:
                    here = near[0]
                    break
        chains.append(chain)
def weighed(name, by):
    return [numpy.average(value[name][c], weights=value[by][c]**-2) * pixel for c in chains]
information = [[numpy.sum(value[by][c]**-2) for by in ("lpx", "lpy")] for c in chains]
merged = {{"x": weighed("x", "lpx"), "y": weighed("y", "lpy"), "photons": [value["photons"][c].sum() for c in chains],
          "sigma_xy": [pixel * ((1 / a + 1 / b) / 2)**.5 for a, b in information], "bg": [value["bg"][c].sum() for c in chains],
          "frame": [value["frame"][c[0]] for c in chains], "merged": [len(c) for c in chains]}}
out = {{}}
for name, values in merged.items():
    v = numpy.sort(numpy.asarray(values, float))
    out[name] = [v[0], v[len(v) // 2], v[-1]]
print(json.dumps({{"n": len(chains), "columns": out}}))
"""
ORIGAMI = pathlib.Path(__file__).resolve().parents[3] / "shared/data/formats/picasso_origami_simulated_locs.hdf5"


@program("PICASSO_PYTHON", "Picasso")
@unittest.skipUnless(ORIGAMI.exists(), "the shared data are not here")
class PicassoLink(PolarCase):
    """input.group does what Picasso's link does, on the same file."""
    @classmethod
    def setUpClass(cls):
        imported = subprocess.run([os.environ["PICASSO_PYTHON"], "-c", "from picasso import postprocess"],
                                  capture_output=True, text=True, timeout=240)
        if imported.returncode != 0:
            raise unittest.SkipTest("picasso.postprocess cannot be imported: " + imported.stderr.strip().splitlines()[-1])

    def compare(self, script, distance, dark_frames):
        script = self.write("link.py", script)
        done = subprocess.run([os.environ["PICASSO_PYTHON"], script], capture_output=True, text=True, timeout=240)
        self.assertEqual(done.returncode, 0, done.stderr)
        theirs = json.loads(done.stdout.splitlines()[-1])
        ours = json.loads(self.ok("inspect", ORIGAMI, "--json", "--set", f"input.group.distance={distance}",
                                  "--set", f"input.group.dark_frames={dark_frames}", "--set", "input.pixel_size_nm=160"))
        self.assertEqual(ours["localisations"], theirs["n"])
        columns = {column["name"]: column for column in ours["columns"]}
        for name, values in theirs["columns"].items():
            for of, value in zip(("minimum", "median", "maximum"), values):
                self.assertLess(abs(columns[name][of] / value - 1) if value else abs(columns[name][of]), 1e-5, (name, of))

    def test_merges_the_same_localisations(self):
        self.compare(LINK.format(file=str(ORIGAMI), reach=10 / 160, dark=1), "10 nm", 1)

    def test_sigmas_merge_what_the_rule_written_out_does(self):
        self.compare(RULE.format(file=str(ORIGAMI), sigmas=2, dark=1), "2 sigma", 1)


if __name__ == "__main__":
    unittest.main()

"""Small sound files of the binary formats: what a fuzzer cannot guess, and real files are too large for.

write(FOLDER) needs numpy and h5py."""
import json
import zipfile

import h5py
import numpy

RECORDS = 6


def minflux(path, iterations):
    """The classic layout: records of iterations, the last one final."""
    iteration = [("itr", "<i4"), ("loc", "<f8", (3,)), ("efo", "<f4"), ("cfr", "<f4")]
    table = numpy.zeros(RECORDS, [("itr", iteration, (iterations,)), ("tid", "<i4"), ("tim", "<f8"), ("vld", "?")])
    table["itr"]["itr"] = numpy.arange(iterations)
    table["itr"]["loc"] = 1e-9 * numpy.random.default_rng(1).normal(100, 5, (RECORDS, iterations, 3))
    table["tid"] = numpy.arange(RECORDS) // 3
    table["vld"] = True
    numpy.save(path, table)


def smlm(path, compression):
    table = numpy.zeros(RECORDS, [("x", "<f4"), ("y", "<f8"), ("sx", "u1"), ("sy", "u1")])
    table["x"], table["sx"], table["sy"] = numpy.arange(RECORDS), 3, 4
    form = {"type": "table", "mode": "binary", "columns": 4, "headers": ["x", "y", "x_precision", "y_precision"],
            "dtype": ["float32", "float64", "uint8", "uint8"], "shape": [1, 1, 1, 1], "units": ["um", "", "nm", "nm"]}
    manifest = {"format_version": "0.2", "formats": {"f": form},
                "files": [{"name": "t.bin", "type": "table", "format": "f", "rows": RECORDS, "offset": {"y": 1000}}]}
    with zipfile.ZipFile(path, "w", compression) as archive:
        archive.writestr("manifest.json", json.dumps(manifest))
        archive.writestr("t.bin", table.tobytes())


def picasso(path, **storage):
    names = ["frame", "x", "y", "z", "photons", "sx", "sy", "lpx", "lpy", "lpz", "group"]
    table = numpy.ones(RECORDS, [(n, "<u4" if n in ("frame", "group") else "<f4") for n in names])
    table["x"] = table["y"] = numpy.arange(RECORDS)
    with h5py.File(path, "w") as file:
        file.create_dataset("locs", data=table, **storage)


def write(folder):
    folder.mkdir(parents=True, exist_ok=True)
    minflux(folder / "one_iteration.npy", 1)
    minflux(folder / "three_iterations.npy", 3)
    smlm(folder / "stored.smlm", zipfile.ZIP_STORED)
    smlm(folder / "deflated.smlm", zipfile.ZIP_DEFLATED)
    picasso(folder / "contiguous.hdf5")
    picasso(folder / "compressed.hdf5", chunks=(2,), compression="gzip", shuffle=True)
    return folder

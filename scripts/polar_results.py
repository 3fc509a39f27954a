"""Results of `polar run` as NumPy arrays. Needs numpy and h5py; nothing of the program itself.

    import polar_results
    r = polar_results.load("results")          # a result directory, or its results.h5
    r.template_from_view[3].apply(points_nm)   # the pose of the fourth particle; None where it was rejected
    r.position_nm[r.particle == 3]             # its localisations in the template frame
    r.template.density, r.template.voxel_nm    # the average as a volume, axes z, y, x
    python polar_results.py results            # draws the average (see draw)
"""
import dataclasses
import json
import pathlib
import sys

import h5py
import numpy as np


@dataclasses.dataclass
class Pose:
    """x_template = rotation x_view + translation_nm, in the table's own nanometres."""
    rotation: np.ndarray
    translation_nm: np.ndarray

    def apply(self, points_nm):
        """Points of the table, shape (n, 3), in the template frame."""
        return np.asarray(points_nm) @ self.rotation.T + self.translation_nm

    def inverse(self):
        return Pose(self.rotation.T, -self.rotation.T @ self.translation_nm)


@dataclasses.dataclass
class Density:
    """Localisations per nm^3 (per nm^2 where it has one slice), axes z, y, x."""
    density: np.ndarray
    voxel_nm: float
    origin_nm: np.ndarray  # x, y, z of the first voxel's centre
    channels: dict         # name -> array of the same shape; empty where there is one channel


@dataclasses.dataclass
class Result:
    name: list                  # of every particle, in the order of the input
    accepted: np.ndarray        # bool, a particle each
    reason: list                # why not accepted
    template_from_view: list    # Pose, or None where rejected
    pose_covariance: np.ndarray  # (particles, 6, 6): rad^2, rad nm, nm^2
    log_likelihood: np.ndarray
    position_nm: np.ndarray     # (localisations, 3): the superparticle, template frame
    covariance_nm2: np.ndarray  # (localisations, 6): xx xy xz yy yz zz
    particle: np.ndarray        # index into name, a localisation each
    columns: dict               # further columns of the input, by heading; texts as lists
    site_nm: np.ndarray         # (K, 3): centres of the fused template
    site_weight: np.ndarray
    summary: dict               # summary.json; empty where it is not there
    template: Density = None    # template.hdf or template.mrc, where one is there
    half_maps: tuple = ()       # half_1.mrc and half_2.mrc, where they are there


def _texts(dataset):
    return [t.decode("utf-8", "replace") if isinstance(t, bytes) else str(t) for t in dataset[()]]


def read_mrc(path):
    """A map as written by this program: 32-bit floats, little endian."""
    data = pathlib.Path(path).read_bytes()
    words, numbers = np.frombuffer(data, "<i4", 256), np.frombuffer(data, "<f4", 256)
    if words[3] != 2 or data[208:212] != b"MAP ":
        raise ValueError(f"{path}: not a map of 32-bit floats")
    x, y, z = (int(n) for n in words[:3])
    start = 1024 + int(words[23])
    density = np.frombuffer(data, "<f4", x * y * z, start).reshape(z, y, x)
    return Density(density, float(numbers[10]) / x / 10, numbers[49:52] / 10.0, {})


def read_template_hdf(path):
    """template.hdf, with the density of every channel."""
    with h5py.File(path, "r") as file:
        group = file["VTKHDF"]
        arrays = {name: data[()] for name, data in group["PointData"].items()}
        channels = {name[len("density_"):]: data for name, data in arrays.items() if name != "density"}
        return Density(arrays["density"], float(group.attrs["Spacing"][0]), np.array(group.attrs["Origin"]), channels)


def _columns(file):
    columns = {}
    for i, (name, unit) in enumerate(zip(_texts(file["input/column_name"]), _texts(file["input/column_unit"]))):
        values = file[f"superparticle/columns/{i}"][()]
        labels = f"input/column_labels/{i}"
        if labels in file:
            texts = _texts(file[labels])
            values = [texts[int(v)] if np.isfinite(v) else "" for v in values]
        columns[name if not unit or unit in name else f"{name} [{unit}]"] = values
    return columns


def load(result):
    """Reads a result directory or a results.h5 (what lies beside it belongs to it)."""
    record = pathlib.Path(result)
    if record.is_dir():
        record = record / "results.h5"
    folder = record.parent
    with h5py.File(record, "r") as file:
        kind = file.attrs.get("format", b"")
        if (kind.decode() if isinstance(kind, bytes) else kind) != "polar-smlm result":
            raise ValueError(f"{record}: not a result of polar run")
        poses, points = file["poses"], file["superparticle"]
        accepted = poses["accepted"][()].astype(bool)
        rotation, translation = poses["rotation"][()], poses["translation"][()]
        r = Result(name=_texts(poses["particle"]), accepted=accepted, reason=_texts(poses["reason"]),
                   template_from_view=[Pose(rotation[i], translation[i]) if ok else None for i, ok in enumerate(accepted)],
                   pose_covariance=poses["covariance"][()], log_likelihood=poses["log_likelihood"][()],
                   position_nm=points["position"][()], covariance_nm2=points["covariance"][()],
                   particle=points["particle"][()], columns=_columns(file), site_nm=file["template/centre"][()],
                   site_weight=file["template/weight"][()], summary={})
    if (folder / "summary.json").exists():
        r.summary = json.loads((folder / "summary.json").read_text())
    if (folder / "template.hdf").exists():
        r.template = read_template_hdf(folder / "template.hdf")
    elif (folder / "template.mrc").exists():
        r.template = read_mrc(folder / "template.mrc")
    halves = [folder / "half_1.mrc", folder / "half_2.mrc"]
    if all(half.exists() for half in halves):
        r.half_maps = tuple(read_mrc(half) for half in halves)
    return r


def draw(result, path="average.png"):
    """An example: projections of the average along z, y and x, with Matplotlib."""
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    average = result.template
    z, y, x = (average.voxel_nm * n for n in average.density.shape)
    figure, axes = plt.subplots(1, 3, figsize=(12, 4))
    for axis, along, width, height, names in ((axes[0], 0, x, y, "xy"), (axes[1], 1, x, z, "xz"), (axes[2], 2, y, z, "yz")):
        axis.imshow(average.density.sum(axis=along), origin="lower", extent=(0, width, 0, height), cmap="inferno")
        axis.set_xlabel(names[0] + " (nm)")
        axis.set_ylabel(names[1] + " (nm)")
    figure.suptitle(f"{int(result.accepted.sum())} of {len(result.accepted)} particles")
    figure.tight_layout()
    figure.savefig(path, dpi=120)
    return path


if __name__ == "__main__":
    if len(sys.argv) not in (2, 3):
        sys.exit("usage: polar_results.py RESULT [PICTURE.png]")
    print(draw(load(sys.argv[1]), *sys.argv[2:]))

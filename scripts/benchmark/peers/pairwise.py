"""From relative motions of pairs to a pose for every view. Runs under --peers-python; needs numpy only."""
import csv
import sys

import numpy as np

NOT_INSTALLED = 77
ROUNDS = 20  # of reweighting; angles change by less than 0.01 degrees after it


def missing(error):
    print(f"not installed: {error}", file=sys.stderr)
    sys.exit(NOT_INSTALLED)


def read_views(path):
    """[(particle, n x 3 points in radii of 100 nm, about their mean, the mean in nm)] in the order of the table."""
    points = {}
    with open(path, encoding="utf-8") as file:
        for row in csv.DictReader(file):
            points.setdefault(row["particle"], []).append([float(row[f"{a} [nm]"]) for a in "xyz"])
    return [(name, (np.array(p) - np.mean(p, axis=0)) / 100, np.mean(p, axis=0)) for name, p in points.items()]


def mean_sigma_nm(path):
    """Mean standard deviation along x, y, z of a table."""
    with open(path, encoding="utf-8") as file:
        return np.mean([[float(row[f"uncertainty_{a} [nm]"]) for a in "xyz"] for row in csv.DictReader(file)], axis=0)


def nearest_rotation(m):
    u, _, vt = np.linalg.svd(m)
    return u @ np.diag([1, 1, np.linalg.det(u @ vt)]) @ vt


def synchronise(n, relative):
    """Rotations R_i (template from view) from relative[i, j] = (rotation i-from-j, weight): leading eigenvectors of the
    weighted block matrix (F. Arrigoni et al., Spectral synchronization of multiple views in SE(3), SIAM J. Imaging
    Sciences 9, 2016), reweighted by the residual so that wrong pairs lose their say."""
    weight = {pair: w for pair, (_, w) in relative.items()}
    for _ in range(ROUNDS):
        block = np.zeros((3 * n, 3 * n))
        degree = np.full(n, 1e-9)
        for (i, j), (r, _) in relative.items():
            w = weight[i, j]
            block[3 * i:3 * i + 3, 3 * j:3 * j + 3] = w * r
            block[3 * j:3 * j + 3, 3 * i:3 * i + 3] = w * r.T
            degree[i] += w
            degree[j] += w
        block += np.kron(np.diag(degree), np.eye(3)) * 1e-6
        scale = np.repeat(1 / np.sqrt(degree), 3)
        _, vectors = np.linalg.eigh(block * scale[:, None] * scale[None, :])
        lead = vectors[:, -3:] * scale[:, None]
        if np.linalg.det(lead[:3]) < 0:
            lead = lead * np.array([1, 1, -1])
        view_from_template = [nearest_rotation(lead[3 * i:3 * i + 3]) for i in range(n)]
        for (i, j), (r, w) in relative.items():
            rest = view_from_template[i].T @ r @ view_from_template[j]
            angle = np.arccos(np.clip((np.trace(rest) - 1) / 2, -1, 1))
            weight[i, j] = w / max(angle, 0.02)
    return [r.T for r in view_from_template]


def quaternion(r):
    k = np.array([[r[0, 0] - r[1, 1] - r[2, 2], 0, 0, 0], [r[0, 1] + r[1, 0], r[1, 1] - r[0, 0] - r[2, 2], 0, 0],
                  [r[0, 2] + r[2, 0], r[1, 2] + r[2, 1], r[2, 2] - r[0, 0] - r[1, 1], 0],
                  [r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1], np.trace(r)]])
    x, y, z, w = np.linalg.eigh(k, UPLO="L")[1][:, -1]
    return w, x, y, z


def write_poses(path, views, rotations):
    """poses.csv; a view's mean is put at the origin, because only rotations are compared."""
    with open(path, "w", encoding="utf-8") as file:
        file.write("particle,n_localisations,n_used,accepted,reason,qw,qx,qy,qz,tx_nm,ty_nm,tz_nm,"
                   "rotation_std_deg,translation_std_nm,log_likelihood,margin\n")
        for (name, points, mean), r in zip(views, rotations):
            numbers = [*quaternion(r), *(-r @ mean)]
            file.write(f"{name},{len(points)},{len(points)},1,," + ",".join(repr(float(v)) for v in numbers) + ",,,,\n")


def register_all(views, register):
    """register(moving, fixed) -> (rotation fixed-from-moving, weight), over all pairs."""
    relative = {}
    for i in range(len(views)):
        for j in range(i + 1, len(views)):
            relative[i, j] = register(views[j][1], views[i][1])
    return synchronise(len(views), relative)

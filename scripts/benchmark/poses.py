"""Errors of pairs of poses, where they are needed beside `polar evaluate`: binned by the pair's own true angle."""
import csv
from pathlib import Path

import numpy as np


def rotations(path: Path):
    """particle -> 3 x 3 rotation (template from view) of every particle that has one."""
    out = {}
    with path.open() as file:
        for row in csv.DictReader(file):
            if row["qw"]:
                w, x, y, z = (float(row[k]) for k in ("qw", "qx", "qy", "qz"))
                out[row["particle"]] = np.array(
                    [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])
    return out


def angle_deg(r):
    """Rotation angle of a stack of matrices; through the sine as well, because arccos is coarse near 0."""
    sine = np.linalg.norm(np.stack([r[..., 2, 1] - r[..., 1, 2], r[..., 0, 2] - r[..., 2, 0],
                                    r[..., 1, 0] - r[..., 0, 1]], axis=-1), axis=-1) / 2
    return np.degrees(np.arctan2(sine, (np.trace(r, axis1=-2, axis2=-1) - 1) / 2))


def pair_errors(estimate: Path, truth: Path):
    """(true relative angle, relative rotation error) of every pair of true particles, degrees; 180 without a pose."""
    e, t = rotations(estimate), rotations(truth)
    names = list(t)
    true = np.stack([t[n] for n in names])
    missing = np.array([n not in e for n in names])
    found = np.stack([e.get(n, np.eye(3)) for n in names])
    i, j = np.triu_indices(len(names), 1)
    # Template-from-view: view_i and view_j differ by T_i^T T_j; right where E_i T_i^T = E_j T_j^T.
    initial = angle_deg(np.einsum("nki,nkj->nij", true[i], true[j]))
    moved = np.einsum("nij,nkj->nik", found, true)
    error = angle_deg(np.einsum("nki,nkj->nij", moved[i], moved[j]))
    return initial, np.where(missing[i] | missing[j], 180.0, error)


def recall_by_angle(initial_deg, error_deg, within_deg=10.0, edges_deg=(0, 45, 90, 135, 180)):
    """Recall of the pairs whose true angle lies in each bin, and the number of pairs."""
    bins = []
    for low, high in zip(edges_deg, edges_deg[1:]):
        inside = (initial_deg > low) & (initial_deg <= high) if low else initial_deg <= high
        count = int(inside.sum())
        bins.append({"low_deg": low, "high_deg": high, "pairs": count,
                     "recall": float((error_deg[inside] <= within_deg).mean()) if count else None})
    return bins

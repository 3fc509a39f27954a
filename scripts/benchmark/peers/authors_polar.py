"""The POLAR authors' own program (package polaregistration) on the processor, with stand-ins of ours for the few parts of
PyTorch3D that it imports. The poses are written from time to time, so that a run cut short has some."""
import argparse
import os
import sys
from pathlib import Path

import numpy as np
import pairwise

SEED = 1
STEPS_BETWEEN_POSES = 50
UNIT_NM = 100  # of pairwise.read_views


def settings(table, views):
    """Its `sigmas`: standard deviations of the table along x, y, z in the unit it works in, the largest distance of a
    point from its view's mean."""
    sigma = pairwise.mean_sigma_nm(table) / UNIT_NM / max(np.linalg.norm(p, axis=1).max() for _, p, _ in views)
    return tuple(float(s) for s in sigma)


def main():
    p = argparse.ArgumentParser()
    p.add_argument("table"), p.add_argument("poses")
    p.add_argument("--rotations", type=int, required=True), p.add_argument("--neighbours", type=int, required=True)
    p.add_argument("--threads", type=int, default=1)
    a = p.parse_args()
    sys.path.insert(0, str(Path(__file__).parent / "stand_ins"))
    os.environ["TORCHDYNAMO_DISABLE"] = "1"  # it compiles its network; views of many sizes make that slower, not faster
    try:
        import torch
        from polar import POLAR
    except (ImportError, OSError) as error:
        pairwise.missing(error)
    torch.manual_seed(SEED)
    torch.set_num_threads(a.threads)
    views = pairwise.read_views(a.table)

    class Watched(POLAR):
        descents, steps = 0, 0

        def write(self):
            # Its points are rows, view = template R + t, so R turns a view's columns into the template's.
            pairwise.write_poses(a.poses, views, self.get_matrix(rotation_only=True).double().numpy())

        def joint_fit(self, z=True):
            self.descents += z
            super().joint_fit(z)
            print(f"polaregistration 0.1.1, {self.descents} joint descents, {self.steps} steps", flush=True)
            if z:
                self.write()

        def log(self, losses, last_lr, memory):
            super().log(losses, last_lr, memory)
            self.steps += 1
            if len(self.X) == len(views) and self.steps % STEPS_BETWEEN_POSES == 0:  # not in a multistart
                self.write()

    model = Watched(L=a.rotations, K=a.neighbours, sigmas=settings(a.table, views))
    model.fit([torch.tensor(points, dtype=torch.float32) for _, points, _ in views])
    print(f"polaregistration 0.1.1, {model.descents} joint descents, {model.steps} steps, finished", flush=True)


if __name__ == "__main__":
    main()

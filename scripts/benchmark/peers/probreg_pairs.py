"""probreg's coherent point drift and FilterReg (rigid), all pairs from the pose as imaged, synchronised. Both are local."""
import argparse
from importlib.metadata import version

import pairwise

ITERATIONS = 50


def main():
    p = argparse.ArgumentParser()
    p.add_argument("table"), p.add_argument("poses"), p.add_argument("--method", choices=("cpd", "filterreg"))
    a = p.parse_args()
    try:
        from probreg import cpd, filterreg
    except (ImportError, OSError) as error:
        pairwise.missing(error)
    views = pairwise.read_views(a.table)

    def register(moving, fixed):
        if a.method == "cpd":
            motion = cpd.registration_cpd(moving, fixed, "rigid", maxiter=ITERATIONS, update_scale=False).transformation
        else:
            motion = filterreg.registration_filterreg(moving, fixed, maxiter=ITERATIONS, objective_type="pt2pt",
                                                      update_sigma2=True).transformation
        return pairwise.nearest_rotation(motion.rot), 1.0

    pairwise.write_poses(a.poses, views, pairwise.register_all(views, register))
    print(f"probreg {version('probreg')}")


if __name__ == "__main__":
    main()

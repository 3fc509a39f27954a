"""Other programs on the same views, each in a process of its own under --peers-python, with a limit of processor time,
beside this program's own ways of registering them."""
import hashlib
from pathlib import Path

from ..program import NothingRegistered, process

# name in the table -> keys of this program
OWN = {"polar": {},
       "polar, latent": {"registration.method": "latent"},
       "polar, the paper's variant": {"registration.method": "latent", "registration.optimizer": "adamw",
                                      "registration.search": "exhaustive"},
       "polar, the paper's variant, 2000 rotations": {"registration.method": "latent",
                                                      "registration.optimizer": "adamw",
                                                      "registration.latent.rotations": 2000}}
# name in the table -> module of this package, its options, and the processor seconds it may take
PEERS = {"Open3D FGR": ("open3d_pairs", ["--method", "fgr"], 900),
         "Open3D RANSAC": ("open3d_pairs", ["--method", "ransac"], 900),
         "probreg CPD": ("probreg_pairs", ["--method", "cpd"], 900),
         "probreg FilterReg": ("probreg_pairs", ["--method", "filterreg"], 900),
         "the authors' POLAR, 2000 rotations": ("authors_polar", ["--rotations", "2000", "--neighbours", "32"], 2400)}
ALL = (*OWN, *PEERS)
NOT_INSTALLED = 77  # exit code of a module whose program is missing
NICENESS = 10       # they take long


class Missing(Exception):
    """A program is not installed."""


def measure(study, point, settings, program, folder: Path, a, kept, wanted):
    """One row a program that is wanted. `kept` holds the row of each in a folder of its own, so that a
    study cut short goes on; rows of other programs are kept by the table that they read, whichever version of this
    program wrote it."""
    if set(wanted) - set(ALL):
        raise SystemExit(f"{study.name}: no programs {sorted(set(wanted) - set(ALL))}, known are {sorted(ALL)}")
    data = folder / "data"
    kept(folder / "simulated", "", lambda: program.simulate(settings, data) or [])
    table = hashlib.sha256((data / "localisations.csv").read_bytes()).hexdigest()[:16]
    rows = []
    for name in (n for n in OWN if n in wanted):
        keys = OWN[name]
        run = {**study.run, **point.run, **keys}
        result = folder / "-".join(w.strip(",'") for w in name.split())
        rows.append({"method": name, **kept(result, str(run), lambda: own(program, data, run, result / "result"))})
    for name in (n for n in PEERS if n in wanted):
        module, options, limit_cpu_s = PEERS[name]
        result = folder.parent / f"views_{table}" / f"{module}_{options[1]}"
        work = lambda: peer(program, a.peers_python, module, options, limit_cpu_s, data, result / "poses.csv")  # noqa: E731
        try:
            row = kept(result, f"{options} {limit_cpu_s}", work) if a.peers_python else {"skipped": "no --peers-python"}
        except Missing as missing:  # not kept: it may be installed by the next call
            row = {"skipped": str(missing)}
        rows.append({"method": name, **row})
    return rows


def own(program, data, run, result):
    try:
        _, cost = program.run(data, run, result)
    except NothingRegistered:
        return {"skipped": "nothing registered"}
    return {"wall_s": cost.wall_s, "cpu_s": cost.cpu_s, "peak_mib": cost.peak_mib, "load": cost.load,
            **score(program, result, data)}


def peer(program, python, module, options, limit_cpu_s, data, poses):
    poses.unlink(missing_ok=True)
    script = Path(__file__).with_name(f"{module}.py")
    done = process([python, script, data / "localisations.csv", poses, *options], limit_cpu_s, NICENESS)
    if done.code == NOT_INSTALLED:
        raise Missing(done.err.splitlines()[-1])
    note = (done.out.strip().splitlines() or [""])[-1]
    if done.cut_off:
        note = f"cut off after {limit_cpu_s} CPU s: {note or 'nothing done'}"
    elif done.code != 0:
        return {"skipped": f"failed: {done.err.splitlines()[-1] if done.err else done.code}"}
    if not poses.is_file():
        return {"skipped": note}
    return {"wall_s": done.cost.wall_s, "cpu_s": done.cost.cpu_s, "peak_mib": done.cost.peak_mib,
            "load": done.cost.load, "note": note, **score(program, poses, data)}


def score(program, poses, data):
    s = program.evaluate(poses, data / "poses.csv")
    recall = {r["angle_deg"]: r["recall_missing_as_wrong"] for r in s["recall"]}
    return {"recall_5": recall[5], "recall_10": recall[10], "median_deg": s["median_pair_deg"]}

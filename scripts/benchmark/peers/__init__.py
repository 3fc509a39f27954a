"""Other programs on the same views, each in a process of its own under --peers-python, with a time limit."""
import subprocess
import time
from pathlib import Path

# name in the table -> module of this package, and what it must import
PEERS = {"Open3D FGR": ("open3d_pairs", ["--method", "fgr"]),
         "Open3D RANSAC": ("open3d_pairs", ["--method", "ransac"]),
         "probreg CPD": ("probreg_pairs", ["--method", "cpd"]),
         "probreg FilterReg": ("probreg_pairs", ["--method", "filterreg"])}
TIME_LIMIT_S = 900
NOT_INSTALLED = 77  # exit code of a module whose program is missing


def measure(study, point, settings, program, folder: Path, a):
    data = folder / "data"
    program.simulate(settings, data)
    summary, cost = program.run(data, {**study.run, **point.run}, folder / "result")
    rows = [{"method": "polar", "wall_s": cost.wall_s, **score(program, folder / "result", data)}]
    for name, (module, options) in PEERS.items():
        if a.peers_python is None:
            rows.append({"method": name, "skipped": "no --peers-python"})
            continue
        poses = folder / f"{module}_{options[-1]}.csv"
        rows.append({"method": name, **outcome(program, a.peers_python, module, options, data, poses)})
    return rows


def outcome(program, python, module, options, data, poses):
    script = Path(__file__).with_name(f"{module}.py")
    start = time.monotonic()
    try:
        done = subprocess.run([python, script, data / "localisations.csv", poses, *options], capture_output=True,
                              text=True, timeout=TIME_LIMIT_S, check=False)
    except subprocess.TimeoutExpired:
        return {"skipped": f"not done after {TIME_LIMIT_S} s"}
    wall_s = time.monotonic() - start
    if done.returncode == NOT_INSTALLED:
        return {"skipped": done.stderr.strip().splitlines()[-1]}
    if done.returncode != 0:
        return {"skipped": f"failed: {done.stderr.strip().splitlines()[-1] if done.stderr.strip() else done.returncode}"}
    return {"wall_s": wall_s, "note": done.stdout.strip(), **score(program, poses, data)}


def score(program, poses, data):
    s = program.evaluate(poses, data / "poses.csv")
    recall = {r["angle_deg"]: r["recall_missing_as_wrong"] for r in s["recall"]}
    return {"recall_5": recall[5], "recall_10": recall[10], "median_deg": s["median_pair_deg"]}

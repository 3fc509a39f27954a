"""Runs a study point by point and object by object. Every measurement is kept as one JSON file under --work and
reused by the next call with the same program, settings and views, so that an interrupted study goes on."""
import hashlib
import json
import os
import platform
from datetime import datetime, timezone

import numpy as np

from . import peers, poses
from .program import NothingRegistered, Refused


def machine():
    model = next((line.split(":")[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")),
                 platform.machine())
    return f"{model}, {len(os.sched_getaffinity(0))} of {os.cpu_count()} cores"


def simulate_settings(study, point, chosen, level, a):
    settings = {**study.simulate, "simulation.particles": study.views[level], "simulation.cramer_rao": False}
    if chosen:
        settings.update({"structure.kind": "file", "structure.file": str(a.shapes.resolve()),
                         "structure.label": chosen["label"], "structure.index": chosen["index"]})
    settings.update(point.simulate)
    return settings


def measure(study, point, settings, program, folder):
    data, result = folder / "data", folder / "result"
    program.simulate(settings, data)
    try:
        summary, cost = program.run(data, {**study.run, **point.run}, result)
    except NothingRegistered as nothing:
        summary, cost = {"accepted": 0, "particles": settings["simulation.particles"]}, nothing.cost
    out = {"wall_s": cost.wall_s, "cpu_s": cost.cpu_s, "peak_mib": cost.peak_mib, "load": cost.load,
           "accepted": summary["accepted"], "particles": summary["particles"],
           "resolution": summary.get("resolution")}
    if summary["accepted"] < 2:
        return {**out, "recall_5": 0.0, "recall_10": 0.0, "median_deg": None, "cdf": [0.0] * 180, "bins": None}
    score = program.evaluate(result, data / "poses.csv")
    recall = {r["angle_deg"]: r["recall_missing_as_wrong"] for r in score["recall"]}
    n, m = score["compared"], score["particles"]
    covered = n * (n - 1) / (m * (m - 1))
    out.update(recall_5=recall[5], recall_10=recall[10], median_deg=score["median_pair_deg"],
               cdf=[covered * share for share in score["cdf_1_to_180_deg"]])
    initial, error = poses.pair_errors(result / "poses.csv", data / "poses.csv")
    out["bins"] = poses.recall_by_angle(initial, error) if score["symmetry"] == "none" else None
    if score["symmetry"] == "none" and abs(float((error <= 10).mean()) - recall[10]) > 1e-3:
        raise RuntimeError(f"{folder}: pairs within 10 degrees differ from polar evaluate")
    return out


def kept(folder, key, work):
    """The record of this key, or what work() returns, kept for the next call."""
    file = folder / "measured.json"
    if file.is_file():
        record = json.loads(file.read_text())
        if record["key"] == key:
            return record["measured"]
    folder.mkdir(parents=True, exist_ok=True)
    measured = work()
    file.write_text(json.dumps({"key": key, "measured": measured}))
    return measured


def object_name(chosen):
    return f"{chosen['label'].split('/')[-1]} {chosen['index']}" if chosen else ""


def run(study, level, program, a):
    record = {"study": study.name, "level": level, "version": program.version(), "machine": machine(),
              "date": datetime.now(timezone.utc).strftime("%Y-%m-%d"), "skipped": "", "points": []}
    objects = study.objects[level] if study.objects else [None]
    record["objects"] = [object_name(o) for o in objects if o]
    record["views"] = study.views[level]
    try:
        for point in study.at(level):
            for chosen in objects:
                settings = simulate_settings(study, point, chosen, level, a)
                key = json.dumps([record["version"], settings, {**study.run, **point.run}], sort_keys=True)
                folder = a.work / study.name / hashlib.sha256(key.encode()).hexdigest()[:16]
                if study.kind == "peers":
                    rows = peers.measure(study, point, settings, program, folder, a, kept,
                                         point.peers.get(level, peers.ALL))
                else:
                    rows = [kept(folder, key, lambda: measure(study, point, settings, program, folder))]
                for row in rows:
                    record["points"].append({"label": point.label, "series": point.series,
                                             "object": object_name(chosen), **row})
                    print(f"{study.name} {point.series} {point.label} {object_name(chosen)} {row.get('method', '')}: "
                          + (row["skipped"] if row.get("skipped") else
                             f"recall {row['recall_5']:.3f} {row['recall_10']:.3f}, {row['wall_s']:.1f} s"), flush=True)
    except Refused as refusal:
        record["skipped"] = str(refusal)
    return record


def grouped(points):
    """[((series, label), rows)] in the order of the study."""
    groups = {}
    for p in points:
        groups.setdefault((p["series"], p["label"]), []).append(p)
    return list(groups.items())


def mean(rows, key):
    values = [r[key] for r in rows if r.get(key) is not None]
    return float(np.mean(values)) if values else float("nan")

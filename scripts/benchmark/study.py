"""Studies: what is simulated, what varies, how it is shown. Layout of the YAML in configs/studies/common.yaml."""
from dataclasses import dataclass, field
from pathlib import Path

import yaml

LEVELS = ("quick", "full")
KINDS = ("sweep", "cdf", "initial_angle", "time", "peers", "resolution")
COMMON = "common.yaml"


@dataclass
class Point:
    """One setting: its place on the x axis (or its curve's name) and what it changes."""
    label: object
    simulate: dict = field(default_factory=dict)
    run: dict = field(default_factory=dict)
    levels: tuple = LEVELS
    series: str = ""  # points of one name are joined in the figure
    peers: dict = field(default_factory=dict)  # level -> the programs that run, of kind peers; a level that is not named: all


@dataclass
class Study:
    name: str
    title: str
    paper: str
    text: str
    kind: str
    axis: str
    points: list
    views: dict     # level -> number of views
    objects: dict   # level -> list of {label, index}; empty for studies that do not use shapes
    simulate: dict  # of every point, beneath the point's own
    run: dict

    def at(self, level):
        return [p for p in self.points if level in p.levels]


def known_keys(entry, known, where):
    unknown = set(entry) - set(known)
    if unknown:
        raise SystemExit(f"{where}: unknown keys {sorted(unknown)}, known are {sorted(known)}")


def load(path: Path, common):
    entry = yaml.safe_load(path.read_text())
    known_keys(entry, ("title", "paper", "text", "kind", "axis", "points", "views", "objects", "simulate", "run"), path)
    if entry["kind"] not in KINDS:
        raise SystemExit(f"{path}: kind is {entry['kind']!r}, expected one of {KINDS}")
    points = []
    for p in entry["points"]:
        known_keys(p, ("label", "simulate", "run", "levels", "series", "peers"), path)
        points.append(Point(**p))
    objects = entry.get("objects", common["objects"])
    objects = {**common["objects"], **objects} if objects else {}
    return Study(name=path.stem, title=entry["title"], paper=entry["paper"], text=entry["text"].strip(),
                 kind=entry["kind"], axis=entry.get("axis", ""), points=points,
                 views={**common["views"], **entry.get("views", {})}, objects=objects,
                 simulate={**(common["simulate"] if objects else {}), **entry.get("simulate", {})},
                 run=entry.get("run", {}))


def load_all(folder: Path, only=None):
    common = yaml.safe_load((folder / COMMON).read_text())
    removed = set(common["symmetric_labels"])
    for level in LEVELS:
        for o in common["objects"][level]:
            if o["label"] in removed:
                raise SystemExit(f"{folder / COMMON}: {o['label']} is listed as symmetric")
    paths = sorted(p for p in folder.glob("*.yaml") if p.name != COMMON)
    unknown = set(only or []) - {p.stem for p in paths}
    if unknown:
        raise SystemExit(f"no study named {sorted(unknown)}; --list names them")
    order = common["order"]
    paths.sort(key=lambda p: order.index(p.stem) if p.stem in order else len(order))
    return [load(p, common) for p in paths if not only or p.stem in only]

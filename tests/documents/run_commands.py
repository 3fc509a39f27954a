"""Runs what documents tell their readers to type: every block of code marked `sh`, in order, each document in a folder
of its own with the sample. A block marked `yaml` that begins with `# name.yaml` is written to that file first. Fails,
naming document and line, where a command does not end with 0.

    python3 run_commands.py ROOT POLAR DOCUMENT..."""
import csv
import os
import shlex
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

PARTICLES = 14
SAMPLE = "datasets/samples/nuclear_pores"
# What readers have of their own, made from the sample.
OWN = ("cells/1.csv", "data/control/cell_1/1.csv", "data/treated/cell_1/1.csv", "other_colour.csv")
# Whether commands are understood is what is asked here, not what the engine finds.
COARSE = {
    "run": ["registration.symmetry=none", "registration.starts=[random]", "output.resolution=none",
            "expert.anneal.rotations=300", "expert.anneal.sweeps=8", "expert.proposals.fewest_starts=1",
            "expert.proposals.most_starts=1", "expert.proposals.most_proposals=0", "expert.refine.noise_tries=1",
            "expert.refine.calibrations=1", "expert.refine.most_searches=1", "expert.refine.rotations=500",
            "expert.refine.basins=2", "expert.refine.fewest_centres=32", "expert.verdict.draws=1"],
    "simulate": [f"simulation.particles={PARTICLES}"]}
COARSE["batch"] = COARSE["run"]


def blocks(text):
    """(line, language, code) of the fenced ones."""
    first, language, lines = 0, None, []
    for number, line in enumerate(text.splitlines(), 1):
        if not line.startswith("```"):
            lines.append(line)
        elif language is None:
            first, language, lines = number + 1, line[3:].strip(), []
        else:
            yield first, language, "\n".join(lines) + "\n"
            language = None


def cut(source, target):
    """The first particles of a table."""
    with open(source, newline="") as table:
        rows = list(csv.reader(table))
    column = rows[0].index("particle")
    target.parent.mkdir(parents=True, exist_ok=True)
    with open(target, "w", newline="") as table:
        csv.writer(table, lineterminator="\n").writerows(
            rows[:1] + [row for row in rows[1:] if int(row[column]) <= PARTICLES])


def furnish(folder, root, polar):
    """What a reader has in front of him."""
    for name in ("configs", "datasets/samples", "scripts"):
        shutil.copytree(root / name, folder / name)
    table = SAMPLE + "/localisations.csv"
    for name in (table, *OWN):
        cut(root / table, folder / name)
    cut(root / SAMPLE / "poses.csv", folder / SAMPLE / "poses.csv")
    program = folder / "bin/polar"
    program.parent.mkdir()
    cases = "".join(f"  {command}) set -- \"$@\" {shlex.join('--set=' + key for key in keys)} ;;\n"
                    for command, keys in COARSE.items())
    program.write_text(f"#!/bin/sh\ncase $1 in\n{cases}esac\nexec {shlex.quote(str(polar))} \"$@\"\n")
    program.chmod(0o755)


def run(document, root, polar):
    """How many blocks ran; ends the program at the first that does not."""
    ran = 0
    with tempfile.TemporaryDirectory(prefix="polar-documents-") as name:
        folder = Path(name)
        furnish(folder, root, polar)
        environment = {**os.environ, "PATH": f"{folder}/bin:{os.environ['PATH']}"}
        for line, language, code in blocks((root / document).read_text(encoding="utf-8")):
            if language == "yaml" and code.startswith("# ") and code.split("\n", 1)[0].endswith(".yaml"):
                (folder / code.split("\n", 1)[0][2:]).write_text(code)
            if language != "sh":
                continue
            ran += 1
            begin = time.monotonic()
            done = subprocess.run(["sh", "-e", "-c", code], cwd=folder, env=environment, text=True, timeout=300,
                                  stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
            if done.returncode != 0:
                sys.exit(f"{done.stdout}{document}:{line}: ended with {done.returncode}:\n{code}")
            print(f"{document}:{line}: {time.monotonic() - begin:.1f} s")
    return ran


def main(root, polar, *documents):
    for document in documents:
        if run(document, Path(root).resolve(), Path(polar).resolve()) == 0:
            sys.exit(f"{document}: no block is marked sh")


if __name__ == "__main__":
    main(*sys.argv[1:])

"""The built program, measured: wall seconds, processor seconds and peak memory of every call."""
import json
import os
import subprocess
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path


class Refused(Exception):
    """The program does not know this configuration (exit code 2)."""


class Failed(Exception):
    """The program ended with another error."""


@dataclass
class Cost:
    wall_s: float
    cpu_s: float
    peak_mib: float


def measured(command):
    """Runs a command; returns its standard output and Cost."""
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        start = time.monotonic()
        process = subprocess.Popen([str(c) for c in command], stdout=out, stderr=err)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        wall_s = time.monotonic() - start
        out.seek(0), err.seek(0)
        text, message = out.read().decode(), err.read().decode().strip()
    if process.returncode == 2:
        raise Refused(message)
    if process.returncode != 0:
        raise Failed(f"{' '.join(map(str, command))}: exit code {process.returncode}: {message}")
    # Linux counts ru_maxrss in KiB.
    return text, Cost(wall_s, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024)


def overrides(settings):
    """`section.key: value` pairs as --set arguments, values as YAML flow text."""
    return [part for key, value in settings.items() for part in ("--set", f"{key}={json.dumps(value)}")]


class Program:
    def __init__(self, path: Path, root: Path):
        self.path, self.root = path, root

    def version(self):
        return measured([self.path, "--version"])[0].strip()

    def simulate(self, settings, directory: Path):
        measured([self.path, "simulate", self.root / "configs/simulate.yaml", "--overwrite", "--output", directory,
                  *overrides(settings)])

    def run(self, data: Path, settings, directory: Path):
        """Registers data/localisations.csv; returns (summary, Cost)."""
        directory.mkdir(parents=True, exist_ok=True)
        config = directory.with_suffix(".yaml")
        config.write_text(f"input: {{files: [{data / 'localisations.csv'}]}}\n"
                          f"output: {{directory: {directory}, formats: [], preview: false}}\n")
        _, cost = measured([self.path, "run", config, "--quiet", "--overwrite", *overrides(settings)])
        return json.loads((directory / "summary.json").read_text()), cost

    def evaluate(self, poses: Path, truth: Path):
        return json.loads(measured([self.path, "evaluate", poses, "--truth", truth, "--json"])[0])

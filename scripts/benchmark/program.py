"""The built program, measured: wall seconds, processor seconds and peak memory of every call."""
import json
import os
import subprocess
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

POLL_S = 0.02


class Refused(Exception):
    """The program does not know this configuration (exit code 2)."""


class Failed(Exception):
    """The program ended with another error."""


class NothingRegistered(Failed):
    """No particle could be registered (exit code 5): a result, of recall 0. Its `cost` is what that took."""
    cost = None


@dataclass
class Cost:
    wall_s: float
    cpu_s: float
    peak_mib: float


def peak_mib(pid):
    """High-water mark of the memory of a running program; 0 before it has any of its own. Not ru_maxrss: that starts at
    what this script itself holds."""
    try:
        lines = Path(f"/proc/{pid}/status").read_text().splitlines()
    except (FileNotFoundError, ProcessLookupError):
        return 0.0
    return max((int(line.split()[1]) / 1024 for line in lines if line.startswith("VmHWM")), default=0.0)


def measured(command):
    """Runs a command; returns its standard output and Cost. Memory is looked at every POLL_S seconds."""
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        start = time.monotonic()
        process = subprocess.Popen([str(c) for c in command], stdout=out, stderr=err)
        peak, pid = 0.0, 0
        while pid == 0:
            peak = max(peak, peak_mib(process.pid))
            time.sleep(POLL_S)
            pid, status, usage = os.wait4(process.pid, os.WNOHANG)
        process.returncode = os.waitstatus_to_exitcode(status)
        wall_s = time.monotonic() - start
        out.seek(0), err.seek(0)
        text, message = out.read().decode(), err.read().decode().strip()
    cost = Cost(wall_s, usage.ru_utime + usage.ru_stime, peak)
    if process.returncode == 0:
        return text, cost
    if process.returncode == 2:
        raise Refused(message.split(".yaml: ")[-1])  # without the place of a file that this script made
    kind = NothingRegistered if process.returncode == 5 else Failed
    failure = kind(f"{' '.join(map(str, command))}: exit code {process.returncode}: {message}")
    failure.cost = cost
    raise failure


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

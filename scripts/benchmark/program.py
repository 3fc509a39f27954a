"""The built program, measured: wall seconds, processor seconds and peak memory of every call."""
import fcntl
import json
import os
import subprocess
import tempfile
import time
from contextlib import contextmanager
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
    load: float  # average of the machine when it began


def peak_mib(pid):
    """High-water mark of the memory of a running program; 0 before it has any of its own. Not ru_maxrss: that starts at
    what this script itself holds."""
    try:
        lines = Path(f"/proc/{pid}/status").read_text().splitlines()
    except (FileNotFoundError, ProcessLookupError):
        return 0.0
    return max((int(line.split()[1]) / 1024 for line in lines if line.startswith("VmHWM")), default=0.0)


def cpu_s(pid):
    """Processor seconds of a running program so far."""
    try:
        fields = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    except (FileNotFoundError, ProcessLookupError, IndexError):
        return 0.0
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


@contextmanager
def alone(lock):
    """Holds the lock file (None: no lock) while something is measured, so that runs on one machine take turns."""
    if lock is None:
        yield
        return
    with open(lock, "a", encoding="utf-8") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        yield


@dataclass
class Ended:
    code: int
    out: str
    err: str
    cost: Cost
    cut_off: bool  # its processor time reached the limit


def process(command, limit_cpu_s=float("inf"), niceness=0):
    """Runs a command to its end or to a limit of processor time; time and memory are looked at every POLL_S seconds."""
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        start, load = time.monotonic(), os.getloadavg()[0]
        child = subprocess.Popen(["nice", "-n", str(niceness), *map(str, command)], stdout=out, stderr=err)
        peak, pid, cut_off = 0.0, 0, False
        while pid == 0:
            peak = max(peak, peak_mib(child.pid))
            if cpu_s(child.pid) > limit_cpu_s:
                cut_off = True
                child.kill()
            time.sleep(POLL_S)
            pid, status, usage = os.wait4(child.pid, os.WNOHANG)
        child.returncode = os.waitstatus_to_exitcode(status)
        wall_s = time.monotonic() - start
        out.seek(0), err.seek(0)
        return Ended(child.returncode, out.read().decode(), err.read().decode().strip(),
                     Cost(wall_s, usage.ru_utime + usage.ru_stime, peak, load), cut_off)


def measured(command):
    """Runs a command; returns its standard output and Cost."""
    ended = process(command)
    if ended.code == 0:
        return ended.out, ended.cost
    if ended.code == 2:
        raise Refused(ended.err.split(".yaml: ")[-1])  # without the place of a file that this script made
    kind = NothingRegistered if ended.code == 5 else Failed
    failure = kind(f"{' '.join(map(str, command))}: exit code {ended.code}: {ended.err}")
    failure.cost = ended.cost
    raise failure


def overrides(settings):
    """`section.key: value` pairs as --set arguments, values as YAML flow text."""
    return [part for key, value in settings.items() for part in ("--set", f"{key}={json.dumps(value)}")]


class Program:
    def __init__(self, path: Path, root: Path, lock: Path = None):
        self.path, self.root, self.lock = path, root, lock

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
        with alone(self.lock):
            _, cost = measured([self.path, "run", config, "--quiet", "--overwrite", *overrides(settings)])
        return json.loads((directory / "summary.json").read_text()), cost

    def evaluate(self, poses: Path, truth: Path):
        return json.loads(measured([self.path, "evaluate", poses, "--truth", truth, "--json"])[0])

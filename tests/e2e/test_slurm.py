"""polar batch --slurm on a Slurm of its own: the same tables as without, whatever happens to its tasks."""
import csv
import json
import os
import signal
import subprocess
import unittest
from pathlib import Path

from harness import POLAR, PolarCase
from slurm_cluster import Cluster, missing
from test_batch import write_batch

PATIENCE_S = 600  # with a machine that is busy; nothing else waits for time
FOLDERS = 'datasets: {folders: "data/*/*", input: localisations.csv}'
SLOWER = """datasets:
  - {folders: "data/*50/*", input: localisations.csv, overrides: {expert: {verdict: {draws: 40, enough_standard_errors: 1000}}}}
  - {folders: "data/*[79]0/*", input: localisations.csv}"""


@unittest.skipUnless(os.environ.get("POLAR_TEST_SLURM"),
                     "it starts Slurm's daemons and races with them: set POLAR_TEST_SLURM=1 to run it")
@unittest.skipIf(missing(), "Slurm is not installed: " + ", ".join(missing()))
class Slurm(PolarCase):
    def setUp(self):
        super().setUp()
        write_batch(self)
        # The first two have seconds of work left after their last checkpoint, on any machine: draws that are never
        # enough.
        self.config.write_text(self.config.read_text().replace(FOLDERS, SLOWER))
        self.cluster = Cluster(cpus=4)
        self.addCleanup(self.cluster.stop)

    def submit(self, *options):
        done = subprocess.run([POLAR, "batch", str(self.config), "--slurm", *options], cwd=self.folder, text=True,
                              capture_output=True, env=self.cluster.environment)
        self.assertEqual(done.returncode, 0, done.stderr)
        words = done.stdout.split()
        return words[words.index("job") + 1].rstrip(","), words[words.index("job", words.index("job") + 1) + 1]

    def states(self, job):
        """Of the job's tasks that are not over, by number; those that wait to begin again are let begin."""
        said = self.cluster.ask("squeue", "--noheader", "--array", "--jobs", job, "--format=%K %T %r")
        if said.returncode != 0 and "Invalid job id" not in said.stderr:
            return {"": said.stderr}  # a controller that is too busy to answer says nothing of the end
        states = {}
        for line in said.stdout.splitlines():
            task, state, reason = line.split(maxsplit=2)
            states[task] = state
            if (state, reason) == ("PENDING", "BeginTime"):
                self.cluster.output("scontrol", "update", f"JobId={job}_{task}", "StartTime=now", check=False)
        return states

    def processes(self, name):
        """Of the task that works on this data set."""
        found = []
        for entry in Path("/proc").glob("[0-9]*/cmdline"):
            try:
                words = entry.read_bytes().split(b"\0")
            except OSError:  # it has ended
                continue
            if b"--no-tables" in words and f"--only={name}".encode() in words:
                found.append(int(entry.parent.name))
        return found

    def catch(self, *names):
        """Stops every task when it has left its first checkpoint, so that no signal comes after its end. Whose
        processes are its own is found out before, so that nothing but the signal lies between the two."""
        found, stopped = {}, set()

        def all_stopped():
            for name in names:
                folder = self.folder / "batch" / name
                if name not in found:
                    if (folder / ".polar.lock").exists():
                        found[name] = self.processes(name)
                elif name not in stopped and any((folder / f"checkpoint.{k}").exists() for k in (1, 2)):
                    for process in found[name]:
                        os.kill(process, signal.SIGSTOP)
                    stopped.add(name)
            return len(stopped) == len(names)

        self.cluster.wait_for(all_stopped, PATIENCE_S, "checkpoints", 0.005)
        for name in names:
            self.assertEqual(len(found[name]), 2, "the program, and the process of the data set")
        return found

    def has_pending(self, process):
        """A signal that ends it, not the one that stops it: where a machine is busy that may still be on its way."""
        words = Path(f"/proc/{process}/status").read_text().split()
        return int(words[words.index("ShdPnd:") + 1], 16) & (1 << signal.SIGUSR1 - 1 | 1 << signal.SIGTERM - 1) != 0

    def disturb(self, job):
        """Puts the first task back into the queue (Slurm lets it go on to end it) and tells the second that its time is
        nearly over; each of its processes goes on when the signal has reached it."""
        stopped = self.catch("labelled_50_cell_0", "labelled_50_cell_1")
        self.cluster.output("scontrol", "requeue", f"{job}_1")
        self.cluster.output("scancel", "--signal=USR1", "--batch", f"{job}_2")
        for process in sorted(stopped["labelled_50_cell_1"]):  # the program, and what it began
            self.cluster.wait_for(lambda: self.has_pending(process), PATIENCE_S, "the signal", 0.01)
            os.kill(process, signal.SIGCONT)

    def rows(self, path):
        with open(self.folder / path, newline="") as table:
            rows = list(csv.DictReader(table))
        for row in rows:
            row.pop("seconds", None)
        return rows

    def test_the_same_tables_as_without(self):
        done = self.polar("batch", self.config, "--output", "whole", "--jobs", 2)
        self.assertEqual(done.returncode, 1, done.stderr)
        tasks, tables = self.submit("--jobs", "3", "--notice", "30")
        self.disturb(tasks)
        self.cluster.wait_for(lambda: not self.states(tasks) and not self.states(tables), PATIENCE_S, "the end of all jobs",
                              0.5)
        logs = self.folder / "batch/tasks"
        requeued, out_of_time = ((logs / f"{tasks}_{number}.log").read_text() for number in (1, 2))
        self.assertIn("stopped by signal 10", out_of_time)
        self.assertIn("continuing from", out_of_time)
        # Slurm lets it go on before it ends it: it may come to its end, and is kept when it begins again.
        self.assertIn("DUE TO JOB REQUEUE", requeued)
        if "stopped by signal 15" in requeued:
            self.assertIn("continuing from", requeued)
        else:
            self.assertIn("0 done, 1 kept", requeued)
        gathered = (logs / f"{tables}.log").read_text()
        self.assertIn("data sets    5 done, 0 kept, of 6", gathered)
        self.assertIn("failed       labelled_70_cell_1: ", gathered)
        for table in ("summary.csv", "conditions.csv"):
            self.assertEqual(self.rows(f"batch/{table}"), self.rows(f"whole/{table}"), table)
        for path in (self.folder / "whole").glob("*/*.csv"):
            self.assertEqual((self.folder / "batch" / path.relative_to(self.folder / "whole")).read_bytes(),
                             path.read_bytes(), path)
        self.assertIn("labelled_50_cell_0/report.html", (self.folder / "batch/report.html").read_text())
        self.mend(tables)

    def mend(self, before):
        self.broken.write_text(self.table)
        script = self.ok("batch", self.config, "--slurm", "--print", "--time", "5", "--cpus", "2")
        self.assertIn("names=(labelled_70_cell_1)\n", script)
        self.assertIn("--time=5", script)
        _, tables = self.submit()
        self.assertGreater(int(tables), int(before))
        self.cluster.wait_for(lambda: not self.states(tables), PATIENCE_S, "the end of the tables", 0.5)
        with open(self.folder / "batch/batch.json") as state:
            states = {d["name"]: d["state"] for d in json.load(state)["datasets"]}
        self.assertEqual(states.pop("labelled_70_cell_1"), "done")
        self.assertEqual(set(states.values()), {"kept"})
        # Nothing is left to submit: the tables are made here.
        self.assertIn("0 done, 6 kept", self.ok("batch", self.config, "--slurm"))


if __name__ == "__main__":
    unittest.main()

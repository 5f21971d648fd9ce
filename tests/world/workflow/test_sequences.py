"""Whatever is edited, stopped, killed or failing: the next plain call ends as a run that never stopped.

The rules and the plan are the project's own; a script that takes a moment stands in for those of its jobs.
"""

import hashlib
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from patience import HANGS_S, wait_for

from .conftest import ROOT, copy_project

SEQUENCES = int(os.environ.get("MOBNET_SEQUENCES", "20"))
FIRST_SEED = int(os.environ.get("MOBNET_FIRST_SEQUENCE", "0"))
TARGET = "figures/smoke/figure_06.pdf"  # of jobs of nearly every kind
CORES = ("--cores", "2", "--config", "scale=smoke")
STAND_IN = Path(__file__).with_name("stand_in.py")
IDLE = {  # file -> rules that an edit of it runs again, to the same bytes
    "src/experiments/jobs/walks.py": "collect",
    "src/experiments/jobs/fitting.py": "fit",
    "src/experiments/jobs/trainings.py": "train",
    "src/experiments/jobs/estimates.py": "estimate",
}
GAINS = (25, 31)  # of the observer: other residuals, and all that follows from them
RULES = ("collect", "observe", "fit", "train", "estimate", "score", "figure_with_bars")
MADE = ("results/smoke", "figures/smoke")
LONGEST_S = 8.0  # from the start of a call to its stop: a call takes three seconds to plan, some jobs a second each
LEAST_S = 2.0

SECOND = (  # words of ./reproduce
    "all", "docs", "films", "report", "tuning", "tables/smoke/table_01.tex", "clean --yes", "snapshot", "all --touch",
    "all --unlock", "results/smoke --delete-all-output",
)  # fmt: skip
REFUSED = rf"a run goes on in this folder since \d\d:\d\d \(.*{TARGET}.*, process \d+\); wait for it, or use a clone"

pytestmark = pytest.mark.slow


def manifest(folder):
    """Return the hash of every file that jobs have made."""
    found = {}
    for place in MADE:
        for path in sorted((folder / place).rglob("*")):
            name = str(path.relative_to(folder))
            if path.is_file() and not path.name.startswith(".") and not {"state", "logs"} & set(path.parts):
                found[name] = hashlib.sha256(path.read_bytes()).hexdigest()
    return found


class Course:
    """A project in which things happen at random moments."""

    def __init__(self, folder, snakemake):
        self.folder = folder
        self.snakemake = snakemake
        self.gain = GAINS[0]
        self.told = []

    def words(self, *more):
        return (*more, *CORES, f"observer={{gain_hz: {self.gain}}}", "--", TARGET)

    def call(self, *more):
        """Run to the end."""
        done = self.snakemake(*self.words(*more), folder=self.folder)
        return done.returncode, done.stdout + done.stderr

    def edit(self, chance):
        """Change code to no effect, or a number."""
        if chance.random() < 0.3:
            self.gain = chance.choice(GAINS)
            self.told.append(f"gain {self.gain}")
            return
        name = chance.choice(list(IDLE))
        path = self.folder / name
        text = path.read_text()
        path.write_text(text + f"\nADDED_{chance.randrange(10**6)} = 1\n")
        self.told.append(f"edit {name}")

    def stop(self, chance):
        """Start a call and stop it, or let one of its jobs fail."""
        forced = chance.choice([(), (), ("--forcerun", chance.choice(RULES)), ("--forceall",)])
        how = chance.choice(["ctrl-c", "kill", "kill all", "fail"])
        self.told.append(f"{how} {' '.join(forced)}")
        if how == "fail":
            rule = chance.choice(RULES)
            (self.folder / "failing.txt").write_text(rule)
            self.call(*forced)
            (self.folder / "failing.txt").unlink()
            return
        python = str(self.folder / ".venv" / "bin" / "python")
        words = [python, "-m", "snakemake", *self.words(*forced)]
        with (self.folder / "out.log").open("ab") as out:
            run = subprocess.Popen(words, cwd=self.folder, stdout=out, stderr=out, start_new_session=True)
        time.sleep(chance.uniform(LEAST_S, LONGEST_S))
        if how == "ctrl-c":
            os.killpg(run.pid, signal.SIGINT)
        elif how == "kill":
            run.kill()  # its jobs live on
        elif run.poll() is None:
            os.killpg(run.pid, signal.SIGKILL)
        run.wait()


@pytest.fixture(scope="module")
def stood_in(tmp_path_factory):
    """A project whose jobs take a moment each."""
    folder = tmp_path_factory.mktemp("sequences")
    copy_project(ROOT, folder)
    for script in (folder / "workflow" / "scripts").glob("*.py"):
        shutil.copy(STAND_IN, script)
    (folder / "src/experiments/evaluation/report/wandb_live.py").write_text("")
    return folder


def test_while_a_run_goes_on_a_second_command_is_refused_and_no_job_of_the_run_fails(stood_in, snakemake):
    held = stood_in / "held.txt"
    held.touch()
    started = [sys.executable, str(stood_in / "reproduce"), TARGET, "--cores", "2", "--forceall"]
    with (stood_in / "out.log").open("w") as out:
        run = subprocess.Popen(started, cwd=stood_in, stdout=out, stderr=out, start_new_session=True)
    try:
        wait_for(lambda: list((stood_in / ".snakemake" / "scripts").glob("*")))
        for second in SECOND:
            words = [sys.executable, str(stood_in / "reproduce"), *second.split()]
            done = subprocess.run(words, cwd=stood_in, capture_output=True, text=True, check=False)
            printed = done.stdout + done.stderr
            assert (done.returncode, re.search(REFUSED, printed) is not None) == (1, True), (second, printed)
        done = snakemake("--cores", "1", TARGET, folder=stood_in)
        assert (done.returncode, done.stdout) == (1, "")
        assert re.fullmatch(REFUSED, done.stderr.splitlines()[-1]), done.stderr
        assert snakemake("-n", TARGET, folder=stood_in).returncode == 0
    finally:
        held.unlink()
    assert run.wait(HANGS_S) == 0, (stood_in / "out.log").read_text()
    assert "failed" not in (stood_in / "out.log").read_text()


def test_after_any_sequence_a_plain_call_makes_the_files_of_an_unbroken_run(stood_in, snakemake):
    course = Course(stood_in, snakemake)
    unbroken = {}
    for course.gain in reversed(GAINS):
        code, printed = course.call()
        assert code == 0, printed
        unbroken[course.gain] = manifest(stood_in)
    assert unbroken[GAINS[0]] != unbroken[GAINS[1]]
    for seed in range(FIRST_SEED, FIRST_SEED + SEQUENCES):
        chance = random.Random(seed)
        course.told = [f"sequence {seed}"]
        for _ in range(chance.randint(1, 2)):
            course.edit(chance)
            course.stop(chance)
        if chance.random() < 0.3:
            course.gain = chance.choice(GAINS)
        code, printed = course.call()
        assert code == 0, (course.told, printed)
        found = manifest(stood_in)
        wanted = unbroken[course.gain]
        different = [name for name in {*found, *wanted} if found.get(name) != wanted.get(name)]
        assert sorted(different) == [], course.told

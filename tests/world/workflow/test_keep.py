"""With `keep=tables` sets go when nothing needs them any more: the same results, and nothing to do afterwards."""

import subprocess
import sys

import pytest

from experiments.plan.dry_run import PlannedJob
from experiments.plan.room import MARGIN, RESOURCE, share_at_once
from experiments.plan.schedule import TimedJob

SCORES = "results/smoke/scores/forward_walk/ideal.csv"
SETS = tuple(f"results/smoke/plant/{kind}/forward_walk/ideal" for kind in ("recordings", "residuals", "estimates"))
UP_TO_DATE = "Nothing to be done"


def test_what_is_let_go_counts_until_its_last_reader_has_ended():
    """Two chains on one core: the recording of the first is gone before that of the second is made."""
    jobs = []
    for name in "ab":
        made = {RESOURCE: "100"}
        jobs.append(TimedJob(PlannedJob("collect", f"collect/{name}", {}, (f"{name}1",), made), 5.0))
        reader = PlannedJob("score", f"score/{name}", {}, (f"{name}2",), {RESOURCE: "20"}, (f"{name}1",), priority=20)
        jobs.append(TimedJob(reader, 1.0))
    assert share_at_once(jobs, 1) == pytest.approx(MARGIN * (100 + 20 + 20) / 240)
    assert share_at_once(jobs, 2) == 1.0  # side by side
    assert share_at_once([], 2) == 1.0


@pytest.mark.slow
@pytest.mark.sim
def test_sets_go_and_results_are_the_same(make_project):
    folder = make_project("keep")

    def run(*words):
        call = [sys.executable, str(folder / "reproduce"), SCORES, *words]
        done = subprocess.run(call, cwd=folder, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stdout + done.stderr
        return done.stdout + done.stderr

    def there():
        return [name for name in SETS if (folder / name).exists()]

    run("--config", "keep=tables")
    assert there() == []
    scores = (folder / SCORES).read_bytes()
    for words in ([], ["--config", "keep=tables"]):
        assert UP_TO_DATE in run(*words, "-n")
        assert UP_TO_DATE in run(*words)
    assert there() == []
    # What needs a recording later makes it again, and it stays where all is kept.
    (folder / SCORES).unlink()
    told = run()
    assert all(f"done: {name}" in told for name in ("record", "observe", "estimate", "score"))
    assert there() == list(SETS)
    assert (folder / SCORES).read_bytes() == scores
    assert UP_TO_DATE in run("--config", "keep=tables", "-n")
    # A change of what makes a recording counts although the recording is gone.
    (folder / SCORES).unlink()
    run("--config", "keep=tables")
    assert there() == []
    changed = run("--config", "keep=tables", "seed=7", "-n")
    assert "collect" in changed
    assert UP_TO_DATE not in changed

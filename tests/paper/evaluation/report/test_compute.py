"""The table of compute adds up what the jobs' own accounts say."""

from dataclasses import asdict
from pathlib import Path

import pytest
from csv_files import read_table

from experiments.evaluation.report.compute import ELAPSED, STAGES, WHOLE, compute
from experiments.running.accounts import Account
from experiments.settings.tables import Compute
from mobnet.core.errors import DataError
from mobnet.core.files import write_json

JOBS = {  # job -> end [s], wall time [s], CPU time [s], memory [MiB]; two cores, and an hour between two runs
    "collect/walk-s1": (1010.0, 10.0, 10.0, 300.0),
    "collect/walk-s2": (1010.0, 10.0, 5.0, 500.5),
    "table_05": (1014.0, 4.0, 4.0, 100.0),
    "paper": (4630.0, 10.0, 10.0, 50.0),
    "score/walk": (4630.2, 0.2, 0.0, 20.0),
}
Uses = dict[tuple[str, str], float]


def write_account(folder: Path, name: str, end: float, wall_s: float, cpu_s: float, mib: float, done: bool) -> None:
    """Write an account as a job does."""
    write_json(folder / f"{name}.json", asdict(Account(name, end - wall_s, end, wall_s, cpu_s, mib, done)))


def made(folder: Path, jobs: dict[str, tuple[float, float, float, float]]) -> Uses:
    """Return the numbers of made-up jobs, one of which failed."""
    for name, numbers in jobs.items():
        write_account(folder / "logs", name, *numbers, done=True)
    write_account(folder / "logs", "train/failed", 9000.0, 9000.0, 9000.0, 9000.0, done=False)
    compute(Compute(pause_s=60.0), folder / "logs", folder / "compute.csv")
    return {(use.stage, use.quantity): use.value for use in read_table(folder / "compute.csv")}


@pytest.fixture
def uses(tmp_path: Path) -> Uses:
    return made(tmp_path, JOBS)


def test_every_job_counts_once_and_the_peak_is_the_largest(uses: Uses) -> None:
    for quantity in ("jobs", "CPU time", "wall time"):
        parts = [uses[stage, quantity] for stage in STAGES if (stage, quantity) in uses]
        assert sum(parts) == pytest.approx(uses[WHOLE, quantity], abs=1e-5)
    assert uses[WHOLE, "jobs"] == len(JOBS)
    assert uses[WHOLE, "CPU time"] == pytest.approx(29 / 3600, rel=1e-4)
    assert uses["collect", "jobs"] == 2
    assert uses["tables and figures", "jobs"] == 1  # a rule of no stage
    assert uses[WHOLE, "peak memory"] == uses["collect", "peak memory"] == 500.5
    assert uses["score", "peak memory"] == 20.0


def test_the_pause_between_two_runs_does_not_count(uses: Uses) -> None:
    """14 s, a pause of more than an hour, 10.2 s; two jobs at once."""
    assert uses[ELAPSED, "wall time"] == pytest.approx(24.2 / 3600, rel=1e-4)
    assert uses[ELAPSED, "cores"] == 2
    assert uses[ELAPSED, "taken"] == pytest.approx(100 * 34.2 / (2 * 24.2), rel=1e-4)
    assert uses[ELAPSED, "load"] == pytest.approx(100 * 29 / (2 * 24.2), rel=1e-4)


def test_a_short_wait_is_part_of_the_run_and_jobs_in_turn_are_not_at_once(tmp_path: Path) -> None:
    jobs = {"collect/a": (1010.0, 10.0, 1.0, 1.0), "collect/b": (1020.0, 10.0, 1.0, 1.0)}
    uses = made(tmp_path, {**jobs, "collect/c": (1070.0, 10.0, 1.0, 1.0)})
    assert uses[ELAPSED, "wall time"] == pytest.approx(70 / 3600, rel=1e-4)
    assert uses[ELAPSED, "cores"] == 1
    assert uses[ELAPSED, "taken"] == pytest.approx(300 / 7, rel=1e-4)


def test_text_has_a_row_a_stage_and_two_of_the_whole(tmp_path: Path) -> None:
    made(tmp_path, {"train/a": (11800.0, 7200.0, 3600.0, 900.4), "collect/b": (4600.0, 3600.0, 3600.0, 5.0)})
    assert (tmp_path / "compute.md").read_text().splitlines()[2:] == [
        "| collect | 1 | 1.00 | 1.00 | 100 | 5 |",
        "| train | 1 | 1.00 | 2.00 | 50 | 900 |",
        "| all jobs | 2 | 2.00 | 3.00 | 67 | 900 |",
        "| elapsed (cores: 1, taken: 100 %) |  |  | 3.00 | 67 |  |",
    ]
    assert r"taken: 100 \%" in (tmp_path / "compute.tex").read_text()


def test_no_account_and_a_damaged_one_are_named(tmp_path: Path) -> None:
    with pytest.raises(DataError, match=r"logs: holds no account of a job; \./reproduce all makes them"):
        compute(Compute(pause_s=60.0), tmp_path / "logs", tmp_path / "compute.csv")
    write_json(tmp_path / "logs" / "paper.json", {"wall_s": 1.0})
    with pytest.raises(DataError, match=r"logs/paper\.json: job: key is missing; accepted: job, start_s"):
        compute(Compute(pause_s=60.0), tmp_path / "logs", tmp_path / "compute.csv")

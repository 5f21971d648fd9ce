"""The table of compute adds up what the benchmark files say, and corrects what Snakemake does not look at."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from snakemake import benchmark

from mobnet.core.errors import DataError
from mobnet.evaluation.number.rows import read_rows
from mobnet.evaluation.report.compute import ELAPSED, FIRST_S, NEXT_S, STAGES, WHOLE, Use, compute, whole_cpu_s

CONFIG = {"evaluation": {"compute": {"pause_s": 60.0}}}
JOBS = {  # file -> end, wall time, CPU time [s], memory [MiB]; two cores, and an hour between two runs
    "collect/walk-s1": (1010.0, 10.0, "10.00", "300.00"),
    "collect/walk-s2": (1010.0, 10.0, "5.00", "500.50"),
    "table_05": (1014.0, 4.0, "4.00", "100.00"),
    "paper": (4630.0, 10.0, "10.00", "50.00"),
    "score/walk": (4630.2, 0.2, "NA", "NA"),
}


def write_benchmarks(folder: Path, jobs: dict[str, tuple[float, float, str, str]]) -> Path:
    """Write benchmark files as Snakemake does."""
    for name, (end, wall_s, cpu_s, memory_mib) in jobs.items():
        path = folder / f"{name}.tsv"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(f"s\th:m:s\tmax_rss\tcpu_time\n{wall_s}\t0:00:00\t{memory_mib}\t{cpu_s}\n")
        log = folder.parent / "logs" / f"{name}.log"
        log.parent.mkdir(parents=True, exist_ok=True)
        log.touch()
        os.utime(log, (end, end))
    return folder


@pytest.fixture
def uses(tmp_path: Path) -> dict[tuple[str, str], float]:
    """The numbers of the made-up jobs."""
    compute(CONFIG, write_benchmarks(tmp_path / "bench", JOBS), tmp_path / "logs", tmp_path)
    return {(use.stage, use.quantity): use.value for use in read_rows(tmp_path / "compute.csv", Use)}


def test_every_job_counts_once(uses: dict[tuple[str, str], float]) -> None:
    for quantity in ("jobs", "CPU time", "wall time"):
        parts = [uses[stage, quantity] for stage in STAGES if (stage, quantity) in uses]
        assert sum(parts) == pytest.approx(uses[WHOLE, quantity], abs=1e-5)
    assert uses[WHOLE, "jobs"] == len(JOBS)
    assert uses[WHOLE, "CPU time"] == pytest.approx(29 / 3600, rel=1e-4)
    assert uses["collect", "jobs"] == 2


def test_a_rule_of_no_stage_makes_tables_and_figures(uses: dict[tuple[str, str], float]) -> None:
    assert uses["tables and figures", "jobs"] == 1


def test_peak_is_the_largest_and_a_job_too_short_to_be_seen_has_none(uses: dict[tuple[str, str], float]) -> None:
    assert uses[WHOLE, "peak memory"] == uses["collect", "peak memory"] == 500.5
    assert uses["score", "peak memory"] == 0


def test_the_pause_between_two_runs_does_not_count(uses: dict[tuple[str, str], float]) -> None:
    """14 s, a pause of more than an hour, 10.2 s; two jobs at once."""
    assert uses[ELAPSED, "wall time"] == pytest.approx(24.2 / 3600, rel=1e-4)
    assert uses[ELAPSED, "cores"] == 2
    assert uses[ELAPSED, "taken"] == pytest.approx(100 * 34.2 / (2 * 24.2), rel=1e-4)
    assert uses[ELAPSED, "load"] == pytest.approx(100 * 29 / (2 * 24.2), rel=1e-4)


def test_a_short_wait_is_part_of_the_run(tmp_path: Path) -> None:
    jobs = {"collect/a": (1010.0, 10.0, "1.0", "1.0"), "collect/b": (1060.0, 10.0, "1.0", "1.0")}
    compute(CONFIG, write_benchmarks(tmp_path / "bench", jobs), tmp_path / "logs", tmp_path)
    uses = {(use.stage, use.quantity): use.value for use in read_rows(tmp_path / "compute.csv", Use)}
    assert uses[ELAPSED, "wall time"] == pytest.approx(60 / 3600, rel=1e-4)
    assert uses[ELAPSED, "taken"] == pytest.approx(100 / 3, rel=1e-4)


def test_text_has_a_row_a_stage_and_two_of_the_whole(tmp_path: Path) -> None:
    jobs = {"train/a": (8200.0, 7200.0, "3597.5", "900.4"), "collect/b": (1000.0, 3600.0, "3585.0", "5.0")}
    compute(CONFIG, write_benchmarks(tmp_path / "bench", jobs), tmp_path / "logs", tmp_path)
    assert (tmp_path / "compute.md").read_text().splitlines()[2:] == [
        "| collect | 1 | 1.00 | 1.00 | 100 | 5 |",
        "| train | 1 | 1.00 | 2.00 | 50 | 900 |",
        "| all jobs | 2 | 2.00 | 3.00 | 67 | 900 |",
        "| elapsed (cores: 1, taken: 100 %) |  |  | 3.00 | 67 |  |",
    ]
    assert r"taken: 100 \%" in (tmp_path / "compute.tex").read_text()


def test_the_intervals_are_snakemakes() -> None:
    assert (FIRST_S, NEXT_S) == (benchmark.BENCHMARK_INTERVAL_SHORT, benchmark.BENCHMARK_INTERVAL)


@pytest.mark.parametrize("wall_s", [0.7, 3.3, 14.9, 15.0, 24.4, 44.9, 46.8, 208.0])
@pytest.mark.parametrize("load", [0.2, 1.0])
def test_a_steady_job_gets_all_its_cpu_time(wall_s: float, load: float) -> None:
    """Snakemake looks at 0, 0.5, ... 15 s, then at 45, 75, ... s and forgets what comes after its last look."""
    looks = [k * FIRST_S for k in range(31)] + [15.0 + NEXT_S * k for k in range(1, 10)]
    seen_s = max(look for look in looks if look <= wall_s)
    assert whole_cpu_s(load * seen_s, wall_s) == pytest.approx(load * wall_s)


def test_no_benchmark_a_damaged_one_and_a_missing_log_are_named(tmp_path: Path) -> None:
    with pytest.raises(DataError, match=r"bench: holds no benchmark; \./reproduce all makes them"):
        compute(CONFIG, tmp_path / "bench", tmp_path / "logs", tmp_path)
    (tmp_path / "bench").mkdir()
    (tmp_path / "bench" / "paper.tsv").write_text("s\tmax_rss\tcpu_time\n1\t1\t1\n")
    with pytest.raises(DataError, match=r"logs/paper\.log: file is missing"):
        compute(CONFIG, tmp_path / "bench", tmp_path / "logs", tmp_path)
    (tmp_path / "bench" / "paper.tsv").write_text("s\tcpu_time\nx\t1\n")
    with pytest.raises(DataError, match=r"bench/paper\.tsv: not a benchmark"):
        compute(CONFIG, tmp_path / "bench", tmp_path / "logs", tmp_path)

"""A job that failed on a cluster is told in one line."""

import os
from pathlib import Path

import pytest

from mobnet.core.cluster import LOGS, failed_jobs, reason


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("17:11:11 INFO epoch 1\nslurmstepd: error: Exceeded job memory limit\n", "RULE:mem_mb=MB"),
        ("slurmstepd: error: *** JOB 6 CANCELLED AT x DUE TO TIME LIMIT ***\n", "RULE:runtime=MINUTES"),
        ("slurmstepd: error: Detected 1 oom_kill event in StepId=6.batch.\n", "RULE:mem_mb=MB"),
        ("12:00:00 ERROR results/: no room is left\n", "results/: no room is left"),
        ("12:00:00 ERROR results/x.parquet: file is missing\nError in rule observe:\n", "results/x.parquet: file is"),
        ("bash: python: command not found\n\n", "bash: python: command not found"),
        ("", "no word of why"),
    ],
)
def test_the_reason_is_told_with_a_remedy_where_there_is_one(text: str, why: str) -> None:
    assert why in reason(text)
    assert "\n" not in reason(text)


def test_only_the_last_attempt_of_jobs_of_this_run_counts(tmp_path: Path) -> None:
    for name, time_s in {"rule_train/LL_0/1": 50, "rule_train/LL_0/2": 60, "rule_fit/x/3": 5}.items():
        path = tmp_path / LOGS / f"{name}.log"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(f"attempt {path.stem}\n")
        os.utime(path, (time_s, time_s))
    (told,) = failed_jobs(tmp_path, 10.0)
    assert told.startswith("rule_train/LL_0: attempt 2 (log: ")

"""A job that failed on a cluster is told in one line."""

import os
import sys

import pytest

from experiments.running.cluster import FEW, LOGS, failed_jobs, warm_cache

HAD = {  # jobs of a rule ask for different limits
    "results/smoke/logs/train/MOB-Net-LL-s0.log": {"mem_mb": 100, "runtime": 30},
    "results/smoke/logs/train/robot_1/MOB-Net-LL-s0.log": {"mem_mb": 300, "runtime": 90},
}
HEADER = "  Command: python -m snakemake --target-jobs {job} --allowed-rules train --cores 2 --attempt {attempt}\n"
BEGUN = """
[Wed Nov 25 03:24:21 2026]
localrule {rule}:
    input: results/smoke/recordings/x.parquet
    log: results/smoke/logs/{log}.log
    jobid: {number}
    reason: Forced execution
    resources: tmpdir=<TBD>, mem_mb=12000, runtime=30
"""
FAILED = """Error in rule {rule}:
    message: None
    jobid: {number}
    log: results/smoke/logs/{log}.log (check log file(s) for error details)
"""
OVER = "slurmstepd: error: Exceeded job memory limit\n"
MORE = "give it more with --set-resources"


def told_of(root, *texts, place="rule_train/_MOB-Net_LL_0", since_s=0.0):
    """Return what is told of logs of one folder, each a second after the one before it."""
    for number, text in enumerate(texts, start=1):
        path = root / LOGS / place / f"{number}.log"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        os.utime(path, (number, number))
    return [line.replace(str(root), "") for line in failed_jobs(root, since_s, HAD)]


@pytest.mark.parametrize(("text", "why"), [
    (f"17:11:11 INFO epoch 1\n{OVER}", "above its 100 MB; give it more with --set-resources train:mem_mb=200"),
    ("error: *** JOB 6 CANCELLED AT x DUE TO TIME LIMIT ***\n", "after its 30 min; give it more with --set-"),
    ("slurmstepd: error: Detected 1 oom_kill event in StepId=6.batch.\n", "--set-resources train:mem_mb=200 (log"),
    ("12:00:00 ERROR results/: no room is left\n", "results/: no room is left (log"),
    ("12:00:00 ERROR results/x.parquet: file is missing\nError in rule train:\n", "results/x.parquet: file is"),
    ("bash: python: command not found\n\n", "bash: python: command not found"),
])  # fmt: skip
def test_the_reason_is_told_with_a_remedy_where_there_is_one(tmp_path, text, why):
    (told,) = told_of(tmp_path, BEGUN.format(rule="train", log="train/MOB-Net-LL-s0", number=0) + text)
    assert told.startswith("train")
    assert why in told
    assert "\n" not in told


@pytest.mark.parametrize(("text", "place", "says"), [
    (OVER, "rule_train/_MOB-Net_LL_0", f"train (MOB-Net_LL_0): ended by SLURM above its limit; {MORE} train:mem_mb=MB"),
    ("", "rule_train/_MOB-Net_LL_0", "train (MOB-Net_LL_0): no word of why (log: "),
    (OVER, "rule_table_05", f"table_05: ended by SLURM above its limit; {MORE} table_05:mem_mb=MB"),
], ids=["before Snakemake began", "without a word", "without wildcards"])  # fmt: skip
def test_a_job_is_named_by_its_place_whatever_it_says(tmp_path, text, place, says):
    (told,) = told_of(tmp_path, text, place=place)
    assert told.startswith(says)


def test_of_a_group_the_job_is_named_that_did_not_end(tmp_path):
    text = BEGUN.format(rule="collect", log="collect/s1", number=3) + "Finished jobid: 3 (Rule: collect)\n"
    text += BEGUN.format(rule="train", log="train/robot_1/MOB-Net-LL-s0", number=4) + OVER
    (told,) = told_of(tmp_path, text, place="group_walks")
    assert told.startswith("train (robot_1/MOB-Net-LL-s0): ended by SLURM above its 300 MB")


def test_of_a_group_the_job_is_named_that_snakemake_names(tmp_path):
    text = "".join(BEGUN.format(rule="fit", log=f"fit/{name}", number=k) for k, name in enumerate(("a", "b")))
    text += "12:00:00 ERROR a.parquet: file is missing\n" + FAILED.format(rule="fit", log="fit/a", number=0)
    (told,) = told_of(tmp_path, text, place="group_fits")
    assert told.startswith("fit (a): a.parquet: file is missing (log: ")


def test_only_the_last_attempt_of_jobs_of_this_run_counts(tmp_path):
    texts = [HEADER.format(job=f"train:limb={limb}", attempt=attempt) for attempt in (1, 2) for limb in ("LL", "RL")]
    old, *new = told_of(tmp_path, *texts, place="group_networks")
    assert "3.log" in old
    assert len(new) == 1
    assert "4.log" in new[0]
    assert told_of(tmp_path, *texts, place="group_networks", since_s=5.0) == []


def test_a_job_that_succeeded_when_it_was_sent_again_is_not_told(tmp_path):
    own = tmp_path / "results" / "smoke" / "logs" / "train" / "MOB-Net-LL-s0.log"
    text = BEGUN.format(rule="train", log="train/MOB-Net-LL-s0", number=0) + OVER
    own.parent.mkdir(parents=True)
    own.touch()
    os.utime(own, (1, 1))
    assert len(told_of(tmp_path, text)) == 1
    os.utime(own, (2, 2))
    assert told_of(tmp_path, text) == []


def test_code_is_compiled_before_many_jobs_and_not_before_few(tmp_path):
    script = tmp_path / "workflow" / "scripts" / "warm.py"
    script.parent.mkdir(parents=True)
    script.write_text("from pathlib import Path\nPath('compiled').touch()\n")
    warm_cache(sys.executable, tmp_path, FEW)
    assert not (tmp_path / "compiled").exists()
    warm_cache(sys.executable, tmp_path, FEW + 1)
    assert (tmp_path / "compiled").exists()

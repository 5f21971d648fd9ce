"""Words that surprise, as Snakemake takes them: each question is a start, so what one can tell stands in tests/plan."""

import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest
import yaml

from experiments.running import environment
from experiments.running.environment import fault_of_snakemake
from mobnet.core.code import ROOT

PROFILE = ROOT / "workflow" / "profiles" / "default" / "config.yaml"
QUIET = {"host", "progress", "rules", "all"}  # what Snakemake 8 knows
TABLE = "tables/smoke/table_01.tex"
NETWORK = "results/smoke/plant/networks/MOB-Net-RL-s0"
# Without site-packages no line of .pth is read, and so nothing leads to this project.
FOREIGN = "import sys; sys.path.append(sys.argv.pop(1)); from snakemake.cli import main; main()"
FULL = "standard output: cannot be written: No space left on device; what was to be printed is lost"


@pytest.mark.parametrize(("words", "line"), [
    (
        ("--config", "scale=smoke", "--config", "seed=3"),
        "--config: is given twice, and Snakemake keeps the last alone; accepted: --config scale=smoke seed=3",
    ),
    (("--set-threads", "trian=4", "--config", "scale=smoke"), "--set-threads: rule: 'trian' is not accepted"),
    ((NETWORK,), f"{NETWORK}: is a folder; accepted: {NETWORK}/weights.safetensors"),
    (("tables/smoke",), "tables/smoke: is a folder; accepted: tables --config scale=smoke, or a file in it"),
])  # fmt: skip
def test_words_of_a_plain_snakemake_are_refused_with_one_line(words, line, snakemake):
    done = snakemake("-n", *words)
    assert done.returncode == 1
    assert done.stdout == ""
    _, told = done.stderr.splitlines()  # the first names the profile
    assert told.startswith(line)


def test_a_dry_run_says_what_a_job_reads_and_why_it_runs(snakemake):
    done = snakemake("-n", "--forcerun", "table", "--", TABLE)
    assert done.returncode == 0
    for said in ("rule table:", f"output: {TABLE.replace('.tex', '.csv')}, {TABLE}", "reason: "):
        assert said in done.stdout


@pytest.mark.parametrize("words", [("-n", TABLE), ("--list-rules",)])
def test_what_snakemake_prints_for_nobody_is_one_line_and_no_success(words):
    run = [sys.executable, "-m", "snakemake", *words]
    with Path("/dev/full").open("w") as full:
        done = subprocess.run(run, cwd=ROOT, stdout=full, stderr=subprocess.PIPE, text=True, check=False)
    assert done.returncode == 1
    assert done.stderr.splitlines()[1:] == [FULL]


@pytest.mark.parametrize("words", [(), ("--workflow-profile", "none")])
def test_a_snakemake_without_the_packages_of_the_project_is_told_where_they_are(words):
    packages = str(Path(find_spec("snakemake").origin).parents[1])
    run = [sys.executable, "-S", "-c", FOREIGN, packages, "-n", "all", *words]
    done = subprocess.run(run, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 1
    *before, line = done.stderr.splitlines()
    assert len(before) == (0 if words else 1), done.stderr
    assert line.startswith("snakemake 9.")
    remedy = "accepted: `./reproduce setup` and `. .venv/bin/activate`, then the same words"
    assert line.endswith(f" runs this file without the packages of the project; {remedy}")


def test_a_snakemake_that_is_too_old_is_one_line(monkeypatch):
    assert fault_of_snakemake() is None
    monkeypatch.setattr(environment, "OLDEST", "99.1")
    assert " is too old; accepted: 99.1 and later, or `./reproduce setup` and " in str(fault_of_snakemake())


def test_the_profile_holds_no_word_that_another_snakemake_refuses():
    said = yaml.safe_load(PROFILE.read_text())
    assert set(said["quiet"]) <= QUIET
    assert not {"logger", "cores", "jobs"} & said.keys()  # -j would do nothing beside cores
    assert [key for key in said if key.startswith("?")] == ['?if find_spec("snakemake_logger_plugin_mobnet")']

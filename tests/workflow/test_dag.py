"""The workflow can be planned at every scale, and a bad configuration stops it with one line."""

import re
import subprocess
import sys

import pytest

from experiments.evaluation.report.paper import missing_packages
from experiments.plan.plan import make_plan
from experiments.settings.load import load_settings

from .conftest import JOB, ROOT, job_of

SCALES = ("smoke", "quick", "default", "paper")


@pytest.mark.parametrize("scale", SCALES)
def test_rules_make_exactly_what_is_planned_and_say_what_they_need(planned, outputs, scale):
    """A rule with an output that its job does not make would fail when it has run."""
    plan = make_plan(load_settings(overrides={"scale": scale}), with_pdf=not missing_packages())
    made = {*plan.stored, *(name for product in plan.products for name in product.outputs)}
    assert outputs(scale).keys() == made
    assert {"table_05", "figure_05", "paper"} <= set(outputs(scale).values())
    without = [job.rule for job in planned(scale) if not {"mem_mb", "runtime"} <= job.resources.keys()]
    assert without == ["all"]  # which runs nothing


def test_resources_are_asked_for_by_the_kind_of_a_rule_or_by_its_name(snakemake):
    given = ("train:mem_mb=777", "train_FTS_e2e_LL_s0:mem_mb=888")
    done = snakemake("-n", "--forceall", "--quiet", "host", "--config", "scale=smoke", "--set-resources", *given)
    jobs = [job_of(*found) for found in JOB.findall(done.stdout + done.stderr)]
    asked = {job.rule: job.resources.get("mem_mb") for job in jobs}
    trained = {name: memory for name, memory in asked.items() if name.startswith("train_")}
    assert trained.pop("train_FTS_e2e_LL_s0") == "888"
    assert set(trained.values()) == {"777"}
    assert asked["fit_MOB_fric"] not in ("777", "888")


def test_what_is_out_of_date_of_a_target_is_priced(snakemake):
    """As many jobs as a dry run counts; all of them where nothing is made yet."""
    target, smoke = "tables/smoke/table_06.tex", ("--config", "scale=smoke")
    planned = snakemake("-n", "--quiet", "host", *smoke, "--", target)
    listed = re.findall(r"^ *(?:local)?rule (\w+):$", planned.stdout + planned.stderr, re.MULTILINE)
    words = (sys.executable, "-m", "experiments.evaluation.report.cost", target, *smoke)
    told = subprocess.run(words, cwd=ROOT, capture_output=True, text=True, check=True).stdout
    assert len(listed) > 0
    assert f"| all jobs | {len(listed)} |" in told


@pytest.mark.parametrize(("given", "message"), [
    ("methods={MOB: {kind: magic}}", "'magic' is not accepted; accepted: "),
    ("robot=configs/robots/none.yaml", "--config: robot: 'configs/robots/none.yaml' is not accepted"),
])  # fmt: skip
def test_bad_configuration_stops_with_one_line(snakemake, given, message):
    done = snakemake("-n", "--config", given)
    assert done.returncode != 0
    assert len([line for line in (done.stdout + done.stderr).splitlines() if message in line]) == 1
    assert "Traceback" not in done.stderr

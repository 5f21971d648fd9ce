"""How much each job has to do."""

import subprocess

import pytest

from experiments.plan.dry_run import PlannedJob, dry_run
from experiments.plan.parts import TOGETHER_S
from experiments.plan.plan import Plan, make_plan
from experiments.plan.work import Work, work_of, works_of
from experiments.settings.catalogue import Catalogue
from experiments.settings.load import load_settings


@pytest.fixture(scope="module")
def plan() -> Plan:
    return make_plan(load_settings(), with_pdf=False)


def work(plan: Plan, job: str, rule: str, **wildcards: str) -> Work:
    """Return the work of a job by the name of its account, its rule and its wildcards."""
    return work_of(plan, PlannedJob(rule, job, wildcards, ("file",), {}))


SETS: list[tuple[str, str, str, str, dict[str, float]]] = [
    ("collect", "plant", "random_walk", "all_uncertainty", {"s": 2400.0, "walk": 8}),
    ("collect", "robot_1", "robot_walk", "robot_1", {"surrogate s": 900.0, "walk": 3}),
    ("collect", "plant", "forward_walk", "ideal", {"s": 12 * 30.0, "walk": 12}),
    ("collect", "robot_2", "changed_walk", "robot_2", {"surrogate s": 4 * 15.0, "walk": 4}),
    ("observe", "plant", "forward_walk", "ideal", {"s": 360.0}),
    ("estimate", "plant", "forward_walk", "ideal", {"s": 360.0, "run": 1.0, "residual s": 360.0, "residual step": 0.0}),
    ("score", "plant", "leg_sines", "all_uncertainty", {"s": 12 * 60.0 * (3 + 2 * 3 + 1)}),
]


@pytest.mark.parametrize(("rule", "robot", "scenario", "level", "amounts"), SETS)
def test_a_job_has_the_recordings_that_it_makes_or_reads(
    plan: Plan, rule: str, robot: str, scenario: str, level: str, amounts: dict[str, float]
) -> None:
    """Of the methods of the Bode figure two have three networks each, one has one, and three have none."""
    found = work(plan, f"{rule}/{robot}/{scenario}-{level}", rule, robot=robot, scenario=scenario, level=level)
    assert (found.kind, found.amounts) == (rule, amounts)


def test_a_product_has_the_sets_that_it_reads(plan: Plan) -> None:
    assert work(plan, "table/table_05", "table", table="table_05").amounts == {}
    steps = work(plan, "table/steps", "table", table="steps")
    assert steps.kind == "steps"
    assert steps.amounts == {"s": 2400.0}


def test_a_motion_has_its_length(plan: Plan) -> None:
    found = work(plan, "motion/random_motion-s1000", "motion", motion="random_motion", seed="1000")
    assert found.amounts == {"s": 150.0}


def test_an_estimate_runs_the_networks_of_the_test_s_limbs(plan: Plan) -> None:
    """The left leg's of MOB-Net, its other trainings and inputs, the gray box, FTS-e2e; the right one."""
    place = {"robot": "robot_2", "scenario": "walk_test", "level": "robot_2"}
    found = work(plan, "estimate/robot_2/walk_test-robot_2", "estimate", **place)
    assert found.amounts["residual s"] == 7 * 4 * 30.0
    assert found.amounts["residual step"] == 30_000.0 * (2 + 1 + 1 + 3)
    assert found.held == 4 * 30.0


def test_an_estimate_of_long_walks_holds_some_of_them_at_a_time(plan: Plan) -> None:
    place = {"robot": "robot_1", "scenario": "long_walk", "level": "robot_1"}
    assert work(plan, "estimate/robot_1/long_walk-robot_1", "estimate", **place).held == TOGETHER_S


def test_a_training_has_its_steps_and_the_numbers_that_it_holds(plan: Plan) -> None:
    """The left leg sees 12 angles and velocities, 6 torques and 12 of the base, and learns 6: Table 1."""
    name = {"robot": "plant", "method": "MOB-Net", "limb": "LL", "seed": "0"}
    found = work(plan, "train/plant/MOB-Net-LL-s0", "train", **name)
    settings = load_settings()
    epochs, size = Catalogue(settings).training("MOB-Net", "LL").epochs, settings.training_sets["walk"].sizes["default"]
    seconds = size.shards * size.shard_s
    steps = 1000 * seconds * epochs
    assert found.amounts == {
        "s": seconds,
        "GRU step": steps,
        "GRU step x unit": 150 * steps,
        "GRU step x unit^2": 150**2 * steps,
    }
    assert found.held == 1000 * seconds * (12 + 6 + 12 + 6)


DRY_RUN = """
localrule all:
    input: tables/smoke/table_05.csv
    jobid: 0
    resources: tmpdir=<TBD>

rule collect:
    output: results/smoke/plant/recordings/forward_walk/ideal
    log: results/smoke/logs/collect/plant/forward_walk-ideal.log
    jobid: 2
    wildcards: robot=plant, scenario=forward_walk, level=ideal
    priority: 20
    resources: tmpdir=<TBD>, mem_mb=2400, runtime=60, disk_mb=8

"""


def test_a_dry_run_tells_its_jobs(plan: Plan, monkeypatch: pytest.MonkeyPatch) -> None:
    """A rule that only names targets has no work."""
    done = subprocess.CompletedProcess([], 0, DRY_RUN, "")
    monkeypatch.setattr("subprocess.run", lambda *_, **__: done)
    planned = dry_run(["all"], ["scale=smoke"])
    assert [job.rule for job in planned] == ["all", "collect"]
    assert planned[1].name == "collect/plant/forward_walk-ideal"
    assert planned[1].resources["disk_mb"] == "8"
    assert [one.job for one in works_of(plan, planned)] == ["collect/plant/forward_walk-ideal"]

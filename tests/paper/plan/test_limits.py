"""What jobs ask of a cluster follows from their prices."""

import pytest
from snakemake.iocontainers import Wildcards

from experiments.plan.limits import LEAST_GPU_MB, LEAST_MB, LEAST_MIN, UNPRICED_MB, UNPRICED_S, JobLimits, limits
from experiments.plan.plan import make_plan
from experiments.settings.load import load_settings

DAY_MIN = 24 * 60
LEG = {"robot": "robot_1", "method": "MOB-Net", "limb": "LL", "seed": "101"}
WIDE = {"robot": "robot_1", "method": "MOB-Net-Single-2X", "limb": "WB", "seed": "101"}
SMALL = {"robot": "plant", "method": "MOB-Net", "limb": "N", "seed": "0"}


def limits_at(scale: str, *, side_by_side: bool = False) -> JobLimits:
    """Return the limits of jobs at a scale."""
    settings = load_settings(overrides={"scale": scale, "stacks": {"side_by_side": side_by_side}})
    return limits(make_plan(settings, with_pdf=False))


@pytest.fixture(scope="module")
def paper() -> JobLimits:
    return limits_at("paper")


def test_a_job_asks_for_what_its_own_work_takes(paper: JobLimits) -> None:
    """The longest training of the scale takes a day, that of the neck minutes: both are jobs of one rule."""
    wide_mb, wide_min = paper.asked("train", WIDE)
    leg_mb, leg_min = paper.asked("train", LEG)
    small_mb, small_min = paper.asked("train", SMALL)
    assert wide_min > 2 * DAY_MIN > leg_min > small_min >= LEAST_MIN
    assert wide_mb > leg_mb > small_mb >= LEAST_MB


def test_a_larger_scale_asks_for_more(paper: JobLimits) -> None:
    robot = {"robot": "robot_1"}
    mb, minutes = paper.asked("detect", robot)
    less_mb, less_min = limits_at("default").asked("detect", robot)
    assert mb > less_mb
    assert minutes > less_min


def test_a_job_that_is_sent_again_asks_for_twice_as_much(paper: JobLimits) -> None:
    w = Wildcards(fromdict=WIDE)
    asked = paper.of("train")
    assert (asked["mem_mb"](w, 1), asked["runtime"](w, 1)) == paper.asked("train", WIDE)
    for function in asked.values():
        assert function(w, 2) == 2 * function(w, 1)


def test_a_rule_of_many_products_asks_by_the_name_of_each(paper: JobLimits) -> None:
    asked = paper.of("{table}")["mem_mb"]
    assert asked(Wildcards(fromdict={"table": "coverage"}), 1) > asked(Wildcards(fromdict={"table": "table_05"}), 1)
    assert asked(Wildcards(fromdict={"table": "table_05"}), 1) == LEAST_MB


def test_jobs_that_the_published_run_did_not_have_get_hours(paper: JobLimits) -> None:
    for name in ("films", "tuning"):
        mb, minutes = paper.asked(name, {})
        assert mb > 2 * UNPRICED_MB
        assert minutes == 2 * UNPRICED_S / 60


def test_what_learns_on_a_gpu_asks_for_the_memory_of_its_libraries_and_for_less_time(paper: JobLimits) -> None:
    beside = limits_at("paper", side_by_side=True)
    stacks = beside.plan.jobs.stacks.members
    asked = [beside.asked("train_stack", {"stack": stack}) for stack in stacks]
    assert min(mb for mb, _ in asked) == LEAST_GPU_MB
    assert LEAST_MIN < max(minutes for _, minutes in asked) < paper.asked("train", WIDE)[1]
    _, minutes = beside.asked("train", LEG)  # which takes its weights from a stack
    assert minutes == LEAST_MIN

"""How much each job has to do."""

import pytest

from experiments.plan.plan import Plan, make_plan
from experiments.plan.work import TOGETHER_S, Work
from experiments.settings.catalogue import Catalogue
from experiments.settings.load import load_settings


@pytest.fixture(scope="module")
def plan() -> Plan:
    return make_plan(load_settings(), with_pdf=False)


@pytest.fixture(scope="module")
def works(plan: Plan) -> dict[str, Work]:
    """Name of a job -> its work, at the default scale."""
    return {work.job: work for work in plan.work}


def test_every_job_is_there_once(plan: Plan, works: dict[str, Work]) -> None:
    assert len(works) == len(plan.work)
    assert {product.name for product in plan.products} <= works.keys()
    networks = plan.files.all_networks()
    assert sum(work.amounts["network"] for work in works.values() if work.kind == "train") == len(networks)


@pytest.mark.parametrize(
    ("job", "amounts"),
    [
        ("collect/random_walk-all_uncertainty-s1000", {"s": 2400.0, "walk": 8}),
        ("collect/robot_1/robot_walk-robot_1-s1000", {"surrogate s": 1200.0, "walk": 4}),
        ("collect/forward_walk-ideal-s260", {"s": 15 * 30.0, "walk": 15}),
        ("collect/robot_2/changed_walk-robot_2-s260", {"surrogate s": 6 * 15.0, "walk": 6}),
        ("motion/random_motion-s1000", {"s": 3600.0, "motion": 24}),
        ("estimate/forward_walk-ideal", {"s": 450.0, "run": 1.0, "residual s": 450.0, "residual step": 0.0}),
        ("score/leg_sines-all_uncertainty", {"s": 15 * 60.0 * (3 + 3 * 3)}),
        ("table_05", {}),
    ],
)
def test_a_job_has_the_recordings_that_it_makes_or_reads(works: dict[str, Work], job: str, amounts: object) -> None:
    """Three methods of the Bode figure have three networks each, four have none."""
    assert works[job].amounts == amounts


def test_an_estimate_runs_the_networks_of_the_test_s_limbs(works: dict[str, Work]) -> None:
    """Both legs' of MOB-Net, the left one of two other trainings, the gray box and FTS-e2e; MOB has none."""
    work = works["estimate/robot_2/walk_test-robot_2"]
    assert work.amounts["residual s"] == 4 * 6 * 30.0
    assert work.amounts["residual step"] == 30_000.0 * (2 + 1 + 1)
    assert work.held == 6 * 30.0


def test_an_estimate_of_long_walks_holds_some_of_them_at_a_time(works: dict[str, Work]) -> None:
    assert works["estimate/robot_1/long_walk-robot_1"].held == TOGETHER_S


def test_a_training_has_its_steps_and_the_numbers_that_it_holds(works: dict[str, Work]) -> None:
    """The left leg sees 12 angles and velocities, 6 torques and 12 of the base, and learns 6: Table 1."""
    work = works["train/MOB-Net-LL-s0"]
    settings = load_settings()
    epochs, size = Catalogue(settings).training("MOB-Net", "LL").epochs, settings.training_sets["walk"].sizes["default"]
    seconds = size.shards * size.shard_s
    steps = 1000 * seconds * epochs
    assert work.amounts == {
        "s": seconds,
        "network": 1.0,
        "GRU step": steps,
        "GRU step x unit": 150 * steps,
        "GRU step x unit^2": 150**2 * steps,
    }
    assert work.held == 1000 * seconds * (12 + 6 + 12 + 6)

"""How much each job has to do."""

import pytest

from mobnet.plan.plan import Plan, make_plan
from mobnet.plan.work import Work, all_work
from mobnet.settings.load import load_settings


@pytest.fixture(scope="module")
def plan() -> Plan:
    return make_plan(load_settings(), with_pdf=False)


@pytest.fixture(scope="module")
def works(plan: Plan) -> dict[str, Work]:
    """Name of a job -> its work, at the default scale."""
    return {work.job: work for work in all_work(plan)}


def test_every_job_is_there_once(plan: Plan, works: dict[str, Work]) -> None:
    assert len(works) == len(all_work(plan))
    assert {product.name for product in plan.products} <= works.keys()
    networks = plan.files.all_networks()
    assert sum(name.startswith("train/") for name in works) == len(networks)


@pytest.mark.parametrize(
    ("job", "amounts"),
    [
        ("collect/random_walk-all_uncertainty-s1000", {"s": 300.0}),
        ("collect/robot_1/robot_walk-robot_1-s1000", {"surrogate s": 300.0}),
        ("collect_tests/forward_walk-ideal", {"s": 15 * 30.0}),
        ("observe_tests/robot_2/changed_walk-robot_2", {"s": 6 * 15.0}),
        ("motion/random_motion-s1000", {"s": 150.0}),
        ("estimate/MOB-n0-forward_walk-ideal", {"residual s": 450.0, "residual step": 0.0}),
        ("estimate/robot_1/MOB-Net-n101-walk_test-robot_1", {"residual s": 180.0, "residual step": 2 * 30_000.0}),
        ("score/leg_sines-all_uncertainty", {"s": 15 * 60.0 * (4 + 3 * 3)}),
        ("table_05", {}),
    ],
)
def test_a_job_has_the_recordings_that_it_makes_or_reads(works: dict[str, Work], job: str, amounts: object) -> None:
    """Three methods of the Bode figure have three networks each, four have none."""
    assert works[job].amounts == amounts


def test_a_training_has_its_steps_and_the_numbers_that_it_holds(works: dict[str, Work]) -> None:
    """The left leg sees 12 angles and velocities, 6 torques and 12 of the base, and learns 6: Table 1."""
    work = works["train/MOB-Net-LL-s0"]
    settings = load_settings()
    epochs, size = settings.training("MOB-Net", "LL").epochs, settings.training_sets["walk"].sizes["default"]
    seconds = size.shards * size.shard_s
    steps = 1000 * seconds * epochs
    assert work.amounts == {
        "s": seconds,
        "GRU step": steps,
        "GRU step x unit": 150 * steps,
        "GRU step x unit^2": 150**2 * steps,
    }
    assert work.held == 1000 * seconds * (12 + 6 + 12 + 6)

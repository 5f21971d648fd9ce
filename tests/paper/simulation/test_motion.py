"""Random motion: within its band, eased in, away from the robot, augmented as section 4.3 says, the same for a seed."""

import numpy as np
import pytest

from experiments.jobs.motions import make_motion, part_and_variant
from experiments.plan.seeds import FIRST_TRAINING_SEED
from mobnet.core.errors import SimulationError
from mobnet.core.store import read_array
from mobnet.simulation.motion import band_limited, hand_targets, shoulder, smooth_step, working_range

SECONDS = 12.0
NAME = "random_motion"


@pytest.fixture(scope="module")
def make(settings):
    """A function (motion, seed, seconds, out) that writes a motion."""
    return lambda motion, *rest: make_motion(settings.seed, settings.robot, motion, NAME, *rest)


@pytest.fixture(scope="module")
def made(motion, make, tmp_path_factory):
    """Knots (T, n) [rad] and notes of a test seed and of the four variants of a part."""
    folder, result = tmp_path_factory.mktemp("motions"), {}
    for seed in (1, *range(FIRST_TRAINING_SEED, FIRST_TRAINING_SEED + 4)):
        make(motion, seed, SECONDS, folder / f"s{seed}")
        knots, meta = read_array(folder / f"s{seed}")
        result[seed] = np.asarray(knots, dtype=float), meta
    return result


def test_columns_are_the_joints_above_the_legs_in_order(made, robot):
    knots, meta = made[1]
    assert [column["name"] for column in meta["columns"]] == [f"q_ref.{name}" for name in robot.layout.actuated[12:]]
    assert {column["unit"] for column in meta["columns"]} == {"rad"}
    assert len(knots) == SECONDS * meta["rate_hz"] + 1


def test_motion_begins_at_rest_in_the_posture(made, robot):
    for knots, _ in made.values():
        np.testing.assert_allclose(knots[0], robot.posture.angle, atol=1e-6)
        np.testing.assert_allclose(knots[1], knots[0], atol=1e-6)
        assert np.abs(knots[-1] - knots[0]).max() > 0.2


def test_same_seed_same_knots(made, motion, make, tmp_path):
    make(motion, 1, 5.0, tmp_path / "again")
    again, _ = read_array(tmp_path / "again")
    same = len(again) - 50  # the filter of a shorter motion sees its end
    np.testing.assert_array_equal(again[:same], made[1][0][:same].astype(np.float32))


def test_knots_stay_apart_slow_and_in_the_working_range(made, motion, robot):
    limits = working_range(motion)
    top = motion.speed_share * np.array([joint.velocity_limit for joint in robot.joints[12:]])
    for knots, meta in made.values():
        assert meta["clearance_m"] >= motion.clearance_least_m
        assert 0.1 < meta["hand_speed_mean_m_s"] < meta["hand_speed_max_m_s"] < 2 * motion.hand_speed_max_m_s
        assert (knots > limits[:, 0] - 1e-4).all()
        assert (knots < limits[:, 1] + 1e-4).all()
        assert (np.abs(np.diff(knots, axis=0)) * meta["rate_hz"] <= top + 1e-3).all()


def spectrum(signal, rate_hz):
    """Return the frequencies (F,) [Hz] of a windowed signal (T, n) and its power at them (F, n)."""
    power = np.abs(np.fft.rfft(signal * np.hanning(len(signal))[:, None], axis=0)) ** 2
    return np.fft.rfftfreq(len(signal), 1 / rate_hz), power


def test_knots_hold_nothing_fast(made):
    """Less than a thousandth of the joints' power lies above 5 Hz, ten times the fastest target and more."""
    for knots, meta in made.values():
        frequency, power = spectrum(knots - knots.mean(axis=0), meta["rate_hz"])
        assert power[frequency > 5].sum() < 1e-3 * power.sum()
        assert power[frequency < 1].sum() > 0.95 * power.sum()


def test_four_training_seeds_are_variants_of_one_part_and_tests_stand_alone(made):
    pairs = [part_and_variant(FIRST_TRAINING_SEED + i, 4) for i in range(12)]
    assert [variant for _, variant in pairs] == [0, 1, 2, 3] * 3
    assert len({part for part, _ in pairs}) == 3
    assert len(set(pairs)) == 12
    tests = {part_and_variant(seed, 4) for seed in range(1, 6)}
    assert {variant for _, variant in tests} == {0}
    assert {part for part, _ in tests}.isdisjoint(part for part, _ in pairs)
    for seed in range(FIRST_TRAINING_SEED + 1, FIRST_TRAINING_SEED + 4):
        assert np.abs(made[seed][0] - made[FIRST_TRAINING_SEED][0]).mean() > 0.05  # not the same motion


def test_a_variant_differs_in_speed_and_in_the_place_of_the_hands(robot, motion):
    """The offset moves both hands' targets by the same amount, mirrored; speed stretches time and nothing else."""
    waves = np.random.default_rng(0).uniform(-1, 1, (5, 6))
    offset, centre = np.array([0.01, 0.02, 0.03]), shoulder(robot)
    moved = hand_targets(centre + offset, motion, waves) - hand_targets(centre, motion, waves)
    np.testing.assert_allclose(moved, np.broadcast_to([offset, offset * [1, -1, 1]], (5, 2, 3)), atol=1e-15)
    time = np.arange(100) / 50
    slow, fast = (band_limited(speed * time, 3, motion, np.random.default_rng(5)) for speed in (0.5, 1.0))
    np.testing.assert_allclose(slow[::2], fast[:50], atol=1e-12)


def test_targets_fill_their_range_evenly_within_the_band(motion):
    time = np.arange(200000) / 50
    signal = band_limited(time, 2, motion, np.random.default_rng(1))
    assert np.abs(signal).max() <= 1
    np.testing.assert_allclose(np.quantile(signal, [0.1, 0.25, 0.5, 0.75, 0.9]), [-0.8, -0.5, 0, 0.5, 0.8], atol=0.06)
    (frequency, power), (lowest, highest) = spectrum(signal, 50), motion.band_hz
    inside = (frequency > lowest - 0.01) & (frequency < highest + 0.01)
    assert power[inside].sum() > 0.95 * power.sum()


def test_arms_are_stretched_from_the_shoulder(robot, motion):
    spans = {"hand_azimuth_rad": (0.0, np.pi), "hand_elevation_rad": (-1.0, 1.0), "hand_distance_m": (0.2, 0.6)}
    centre, motion = shoulder(robot), motion.model_copy(update=spans)
    ahead, aside = hand_targets(centre, motion, np.array([[-1, 0, 1, -1, 0, 1], [0, 0, -1, 0, 0, -1.0]]))
    np.testing.assert_allclose(ahead[0], centre + [0.6, 0, 0], atol=1e-12)
    np.testing.assert_allclose(aside[0], centre + [0, 0.2, 0], atol=1e-12)
    np.testing.assert_allclose(aside[1], (centre + [0, 0.2, 0]) * [1, -1, 1], atol=1e-12)


def test_smooth_step_has_no_jump_in_speed():
    x = np.linspace(-0.5, 1.5, 20001)
    y = smooth_step(x)
    assert (y[0], y[-1]) == (0, 1)
    assert np.abs(np.diff(y, 2)).max() < 1e-7


def test_too_near_is_refused(motion, make, tmp_path):
    with pytest.raises(SimulationError, match=r"between two solids at .* s is not accepted; accepted: >= 0.12"):
        make(motion.model_copy(update={"clearance_least_m": 0.12}), 1, 3.0, tmp_path / "near")
    assert not list(tmp_path.iterdir())

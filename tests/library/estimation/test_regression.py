"""Friction that was put into a residual comes out of the regression."""

from dataclasses import replace

import numpy as np
import pytest
import scipy

from mobnet.core.columns import residual_columns
from mobnet.core.errors import DataError
from mobnet.core.joints import N_VIRTUAL
from mobnet.core.recording_file import write_recording
from mobnet.core.store import write_array
from mobnet.estimation.regression import TERMS, Law, non_negative, regress
from mobnet.kernel.low_pass import low_pass

GAIN_HZ, RATE_HZ, SMOOTHING = 100.0, 1000.0, 0.02
TRUE = {"coulomb_nm": 12.0, "static_nm": 9.0, "viscous_nms": 3.0, "load_per_nm": 0.002, "stribeck_rad_s": 0.3}
LAW = Law(SMOOTHING, (0.1, 0.3, 1.0), GAIN_HZ)
LEG = tuple(f"LL{i}" for i in range(1, 7))


def friction(recording, numbers):
    """Return (23) of every actuated joint, (T, nu) [N m], written out."""
    v, tau = recording.sensed.v[:, N_VIRTUAL:], recording.sensed.tau_motor
    fade = np.exp(-np.abs(v) / numbers["stribeck_rad_s"])
    dry = numbers["coulomb_nm"] + (numbers["static_nm"] - numbers["coulomb_nm"]) * fade
    return -np.tanh(v / SMOOTHING) * (dry + numbers["load_per_nm"] * tau**2) - numbers["viscous_nms"] * v


def fit(*pairs, terms=TERMS, joints=LEG):
    return regress(LAW, {joint: list(terms) for joint in joints}, pairs)


@pytest.fixture
def write(tmp_path, layout):
    """Return a function that writes a recording, and as its residual a torque (T, nu) behind the observer's filter."""

    def written(name, recording, torque):
        stems = tmp_path / f"{name}-recording", tmp_path / f"{name}-residual"
        write_recording(stems[0], recording, layout)
        external = np.full(recording.sensed.v.shape, 7.0)
        residual = external.copy()
        for span in recording.spans():
            residual[span, N_VIRTUAL:] += low_pass(torque[span], GAIN_HZ, RATE_HZ)
        columns = residual_columns(layout)
        array = np.concatenate([residual, external], axis=1)
        write_array(stems[1], array, columns, {"rate_hz": RATE_HZ}, recording.segments)
        return stems

    return written


@pytest.fixture
def pair(write, made_up):
    recording = made_up(3, 4.0, segments=2)
    return write("one", recording, friction(recording, TRUE))


def test_known_friction_is_recovered(pair):
    """The closed form of (23) behind the low-pass of (11): an unfiltered regressor leaves several N m."""
    found = fit(pair)
    assert tuple(found) == LEG
    for row in found.values():
        assert row["stribeck_rad_s"] == TRUE["stribeck_rad_s"]
        assert {key: row[key] for key in TRUE} == pytest.approx(TRUE, rel=1e-3)
        assert row["left_rms_nm"] < 1e-3 < row["target_rms_nm"]


def test_recordings_add_up(write, made_up):
    """Two recordings, in either order, are equivalent to one of two segments."""
    whole = made_up(3, 4.0, segments=2)
    torque = friction(whole, TRUE) + np.random.default_rng(0).normal(0, 5, whole.sensed.tau_motor.shape)
    pairs = []
    for k, span in enumerate(whole.spans()):
        half = replace(whole, sensed=whole.sensed[span], truth=whole.truth[span], segments=((0, 2000),))
        pairs.append(write(f"half{k}", half, torque[span]))
    one = fit(write("whole", whole, torque))
    for order in (pairs, pairs[::-1]):
        for joint, row in fit(*order).items():
            assert row == pytest.approx(one[joint], rel=1e-6, abs=1e-9)


def test_friction_never_drives(write, made_up):
    """No factor falls below zero, even where the torque pushes along with the motion."""
    recording = made_up(3, 2.0)
    for row in fit(write("driven", recording, -friction(recording, TRUE))).values():
        assert [row[key] for key in TRUE if key != "stribeck_rad_s"] == [0.0] * 4
        assert row["left_rms_nm"] == pytest.approx(row["target_rms_nm"])


def test_a_joint_at_rest_has_no_friction(write, made_up):
    recording = made_up(3, 1.0)
    still = replace(recording, sensed=replace(recording.sensed, v=np.zeros_like(recording.sensed.v)))
    for row in fit(write("still", still, np.ones_like(recording.sensed.tau_motor))).values():
        assert [row[key] for key in TRUE if key != "stribeck_rad_s"] == [0.0] * 4


def test_only_named_terms_are_fitted(pair):
    for row in fit(pair, terms=("coulomb", "viscous")).values():
        assert row["load_per_nm"] == 0.0
        assert row["static_nm"] == row["coulomb_nm"] > 0.0


def test_a_residual_of_another_recording_is_refused(pair, write, made_up):
    short = made_up(0, 0.5)
    other = write("short", short, friction(short, TRUE))
    with pytest.raises(DataError, match=r"one-residual\.json: rows: 4000 is not accepted; accepted: 500, as in "):
        fit((other[0], pair[1]))


@pytest.mark.parametrize("seed", range(5))
def test_factors_of_either_sign_are_those_of_bounded_least_squares(seed):
    """Columns of sizes from 0.01 to 1000, as velocities and torques have; the first and the last may be negative."""
    rng, sizes = np.random.default_rng(seed), np.array([1e3, 1e-2, 1.0, 30.0, 1.0])
    columns = (rng.normal(0, 1, (500, 5)) + rng.normal(0, 3, (500, 1))) * sizes
    target = columns @ (rng.normal(0, 1, 5) / sizes) + rng.normal(0, 0.1, 500)
    table = np.column_stack([columns, target])
    names = dict(zip("abcde", np.eye(6), strict=False))
    factors, left = non_negative(table.T @ table / 500, names, free="ae")
    lowest = np.array([-np.inf, 0.0, 0.0, 0.0, -np.inf])
    expected = scipy.optimize.lsq_linear(columns / sizes, target, (lowest, np.inf), method="bvls")
    np.testing.assert_allclose([factors[name] for name in "abcde"] * sizes, expected.x, atol=1e-3)
    assert left == pytest.approx(np.sqrt(2 * expected.cost / 500), rel=1e-3)


@pytest.mark.parametrize("seed", range(8))
def test_columns_that_are_one_another_s_multiples_have_factors_in_spite_of_rounding(seed):
    """The least eigenvalue of their products is zero but for rounding, which may make it negative."""
    rng = np.random.default_rng(seed)
    column = rng.normal(size=(50, 1))
    products = np.hstack([column, 3.0 * column, 7.0 * column])
    products = products.T @ products
    factors, left = non_negative(products, {"one": np.eye(3)[0], "three": np.eye(3)[1]})
    assert factors["one"] + 3.0 * factors["three"] == pytest.approx(7.0)
    assert left == pytest.approx(0.0, abs=1e-5)


def test_recordings_without_a_segment_fit_nothing(write, made_up):
    recording = replace(made_up(3, 1.0), segments=())
    for row in fit(write("nowhere", recording, np.zeros_like(recording.sensed.tau_motor))).values():
        assert not any(number for name, number in row.items() if name != "stribeck_rad_s")

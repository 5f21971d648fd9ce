"""Friction with a memory: Dahl's law in closed form, the fit that finds it again, and online what is found offline."""

import json
from dataclasses import replace

import numpy as np
import pytest
from library_settings import network_of

from mobnet.core.columns import residual_columns
from mobnet.core.errors import DataError
from mobnet.core.joints import N_VIRTUAL
from mobnet.core.recording_file import write_recording
from mobnet.core.store import write_array
from mobnet.estimation.kinds.dahl import TERMS, DahlFriction, Options, bent, build, fit, read_dahl
from mobnet.estimation.kinds.friction import FrictionModel, read_friction
from mobnet.kernel.low_pass import low_pass

GAIN_HZ, RATE_HZ = 100.0, 1000.0
ANGLES = (0.002, 0.004, 0.02)
LEG = {"breakaway_rad": 0.004, "forward_nm": 9.0, "backward_nm": 7.0, "driving": 0.2, "driven": 0.35,
       "viscous_nms": 3.0, "constant_nm": -1.5, "gain": 0.04}  # fmt: skip
ARM = LEG | {"driving": 0.0, "driven": 0.0, "gain": 0.0}  # its network does not see the torque


def written_out(velocity, torque, numbers):
    """Return the friction of one joint, (T,) [N m], sample by sample, from (O19) and (O20) as they stand."""
    bend, found = 0.0, []
    for v, tau in zip(velocity, torque, strict=True):
        sign = 1.0 if v > 0 else -1.0
        bend = sign + (bend - sign) * np.exp(-abs(v) / RATE_HZ / numbers["breakaway_rad"])
        coulomb = numbers["forward_nm" if bend > 0 else "backward_nm"]
        load = numbers["driving" if bend * tau > 0 else "driven"]
        known = numbers["viscous_nms"] * v + numbers["constant_nm"] + numbers["gain"] * tau
        found.append(-(coulomb + load * abs(tau)) * bend - known)
    return np.array(found)


@pytest.fixture
def fitted(tmp_path):
    """A fit of the left knee alone."""
    path = tmp_path / "fit.json"
    path.write_text(json.dumps({"law": "dahl", "joints": {"LL4": LEG}}))
    return path


@pytest.fixture
def friction(layout):
    """Friction of all joints, with other numbers in each."""
    rng = np.random.default_rng(3)
    factors = {term: rng.uniform(0.01, 1.0, layout.nu) for term in TERMS}
    return DahlFriction(factors, rng.uniform(0.001, 0.02, layout.nu))


def test_a_bend_grows_with_the_angle_and_turns_at_a_reversal():
    """Dahl's law in closed form: 1 - exp(-turn / angle) from rest, 2 exp(-turn / angle) - 1 after a reversal."""
    angle, forth = 0.004, np.full((50, 1), 0.1)
    state = np.zeros(1)
    bends = bent(state, np.concatenate([forth, -forth]), np.array([angle]), RATE_HZ)[:, 0]
    turn = 0.1 / RATE_HZ * np.arange(1, 51)
    there = 1 - np.exp(-turn / angle)
    np.testing.assert_allclose(bends[:50], there, rtol=1e-12)
    np.testing.assert_allclose(bends[50:], (1 + there[-1]) * np.exp(-turn / angle) - 1, rtol=1e-12)
    assert state[0] == bends[-1]


def test_a_known_hysteresis_comes_out_of_the_fit(settings, made_up, layout, tmp_path):
    """Two segments, each from a fresh state, behind the observer's low-pass; terms of the torque in the leg alone."""
    recording = made_up(3, 4.0, segments=2)
    motion = recording.sensed.v[:, N_VIRTUAL:].astype(np.float32), recording.sensed.tau_motor.astype(np.float32)
    limbs = {"LL": LEG, "LA": ARM}
    residual = np.full(recording.sensed.v.shape, 7.0)
    external = residual.copy()
    for limb, numbers in limbs.items():
        for joint in layout.limb(limb):
            j = layout.actuated.index(joint)
            for span in recording.spans():
                torque = written_out(*(signal[span, j].astype(float) for signal in motion), numbers)
                residual[span, N_VIRTUAL + j] += low_pass(torque, GAIN_HZ, RATE_HZ)
    stems = tmp_path / "recording", tmp_path / "residual"
    write_recording(stems[0], recording, layout)
    array = np.concatenate([residual, external], axis=1)
    write_array(stems[1], array, residual_columns(layout), {"rate_hz": RATE_HZ}, recording.segments)
    networks = {limb: network_of(settings, "MOB-fric-dahl", limb) for limb in limbs}
    training = dict.fromkeys(limbs, (stems,))
    joints = fit(settings.layout, settings.observer, Options(breakaway_rad=ANGLES), networks, training)["joints"]
    assert set(joints) == {joint for limb in limbs for joint in layout.limb(limb)}
    for joint, row in joints.items():
        assert {key: row[key] for key in LEG} == pytest.approx(LEG if joint in layout.limb("LL") else ARM, rel=0.01)
        assert row["left_rms_nm"] < 0.01 < row["target_rms_nm"]


def test_what_never_moves_has_no_friction(settings, made_up, write_pair, tmp_path):
    recording = made_up(3, 1.0)
    still = replace(recording, sensed=replace(recording.sensed, v=np.abs(recording.sensed.v)))
    networks = {"LL": network_of(settings, "MOB-fric-dahl", "LL")}
    given = settings.layout, settings.observer, Options(breakaway_rad=ANGLES), networks
    for row in fit(*given, {"LL": [write_pair(tmp_path, still)]})["joints"].values():
        assert row["backward_nm"] == 0.0


def test_online_is_offline_to_the_bit(layout, friction, made_up):
    """One sample at a time, and a whole recording, whose second stretch starts afresh."""
    model, sensed = FrictionModel(layout, friction, GAIN_HZ, RATE_HZ), made_up(5, 0.5).sensed
    whole, again = model.run_all([sensed, sensed])
    state, rows = model.init(), []
    for k in range(len(sensed)):
        state, row = model.step(state, sensed[k])
        rows.append(row.mean)
    np.testing.assert_array_equal(np.array(rows), whole.mean)
    np.testing.assert_array_equal(again.mean, whole.mean)
    assert not whole.mean[:, :N_VIRTUAL].any()
    joint = {term: factors[3] for term, factors in friction.factors.items()} | {"breakaway_rad": friction.breakaway[3]}
    expected = written_out(sensed.v[:, N_VIRTUAL + 3], sensed.tau_motor[:, 3], joint)
    np.testing.assert_allclose(whole.mean[:, N_VIRTUAL + 3], low_pass(expected, GAIN_HZ, RATE_HZ), rtol=1e-9)


def test_joints_that_were_not_fitted_are_those_of_the_observer(changed_joints, layout, fitted):
    assert changed_joints(build, "MOB-fric-dahl", fitted) == ["LL4"]
    read, knee = read_dahl(fitted, layout.actuated), layout.actuated.index("LL4")
    assert {term: factors[knee] for term, factors in read.factors.items()} == {term: LEG[term] for term in TERMS}


def test_the_fit_of_another_law_is_refused(fitted, layout):
    with pytest.raises(DataError, match=r"fit\.json: smoothing_rad_s: key is missing; accepted: "):
        read_friction(fitted, layout.actuated)

"""Pushes: when they come, how hard, and that the external torque is theirs."""

from itertools import pairwise
from typing import get_args

import numpy as np
import pytest

from mobnet.settings.data import Direction, Phase, Push
from mobnet.simulation.pushes import DIRECTIONS, LAW, PHASES, SHAPES, STATE, Pushes, advance_impactor, hit, meet

LL3 = 6 + 2


def pushed(simulate, **rows):
    return simulate("flat_place", "ideal", pushes=rows, scenarios={"flat_place": {"pushes": list(rows)}})


def watch(simulator, run, seconds):
    seen = []
    for _ in range(round(seconds * 1000)):
        log = run(simulator, 0.001)
        s = simulator.state
        seen.append({
            "clock": s.clock, "swinging": s.swinging, "side": s.side, "share": s.t / s.total,
            "state": simulator.pushes.state.copy(), "tau_ext": log["tau_ext"][0].copy(),
            "tau_push": log["tau_push"][0].copy(),
            "wrench": np.concatenate([log["wrench_left_foot"][0], log["wrench_right_foot"][0]]),
            "contact": log["contact"][0].copy(), "pushed": log["pushed"][0, 0],
        })  # fmt: skip
    return seen


def test_force_at_a_point_is_a_wrench_about_the_centre_of_mass_of_its_body(simulate, run):
    """What such a wrench does to the external torque is tested with the plant's loop."""
    row = {"point": "left_hand", "at_s": [0.0], "force_n": [30.0, 30.0], "duration_s": [9.0, 9.0], "direction": "down"}
    simulator = pushed(simulate, load={**row, "shape": "step"})
    run(simulator, 2.2)
    data, site = simulator.world.data, simulator.world.model.site("left_hand")
    force, moment = np.split(data.xfrc_applied[site.bodyid[0]], 2)
    assert force == pytest.approx([0, 0, -30])
    arm = data.site_xpos[site.id] - data.xipos[site.bodyid[0]]
    np.testing.assert_allclose(moment, np.cross(arm, force), atol=0.02)  # the point is of the step before


def test_a_moment_comes_and_goes_with_its_force_about_any_axis(simulate, run):
    row = {"point": "right_hand", "pause_s": [0.05, 0.1], "force_n": [10.0, 10.0], "moment_nm": [1.0, 2.0]}
    simulator = pushed(simulate, hand={**row, "duration_s": [0.1, 0.1], "direction": "any", "shape": "half_sine"})
    data, site, moments = simulator.world.data, simulator.world.model.site("right_hand"), []
    for _ in range(300):
        run(simulator, 0.011)
        force, moment = np.split(data.xfrc_applied[site.bodyid[0]], 2)
        push, arm = simulator.pushes.state[0], data.site_xpos[site.id] - data.xipos[site.bodyid[0]]
        share = np.linalg.norm(force) / 10.0
        np.testing.assert_allclose(moment, np.cross(arm, force) + share * push["moment"], atol=0.02)
        moments.append(push["moment"].copy())
    sizes = np.linalg.norm(moments, axis=1)[np.any(moments, axis=1)]
    assert 1.0 <= sizes.min() < 1.2 < 1.8 < sizes.max() <= 2.0
    assert np.abs(np.mean(moments, axis=0)).max() < 0.6


def test_torque_on_a_joint_is_external_torque_of_that_joint_alone(simulate, run):
    row = {"joint": "LL3", "during": "left_swing", "share": [0.4, 0.4], "at_s": [0.0], "torque_nm": [30.0, 30.0]}
    seen = watch(pushed(simulate, step={**row, "duration_s": [0.1, 0.1], "shape": "step"}), run, 4.0)
    torque = np.array([moment["tau_ext"] for moment in seen])
    on = np.array([moment["state"]["active"][0] for moment in seen]) > 0
    assert on.sum() == pytest.approx(100, abs=2)
    middle = np.flatnonzero(on)[5:-5]
    assert all(moment["pushed"] == 1 for moment in np.array(seen)[middle])
    assert sum(moment["pushed"] for moment in seen) == pytest.approx(100, abs=2)
    np.testing.assert_allclose(torque[middle, LL3], 30.0, atol=1e-4)
    np.testing.assert_allclose(np.delete(torque[middle, 6:12], 2, axis=1), 0, atol=1e-4)
    first = seen[np.flatnonzero(on)[0]]
    assert (first["side"], first["swinging"]) == (-1.0, 1)
    assert first["share"] == pytest.approx(0.4, abs=0.05)


def test_half_sine_has_its_peak_and_length_and_the_foot_feels_it(simulate, run):
    row = {"point": "left_sole", "during": "left_swing", "share": [0.4, 0.4], "at_s": [0.0], "force_n": [50.0, 50.0]}
    row |= {"duration_s": [0.1, 0.1], "direction": "horizontal", "shape": "half_sine"}
    seen = watch(pushed(simulate, foot=row), run, 4.0)
    on = [moment for moment in seen if moment["state"]["active"][0]]
    felt = np.array([np.linalg.norm(moment["wrench"][:3]) for moment in on])
    assert len(on) == pytest.approx(100, abs=2)
    assert felt.max() == pytest.approx(50.0, rel=0.01)
    assert felt.sum() / 1000 == pytest.approx(50.0 * 0.1 * 2 / np.pi, rel=0.02)
    assert not any(moment["contact"][0] for moment in on)  # a push is no ground


@pytest.mark.parametrize(("phase", "side"), [("left_support", 1.0), ("right_support", -1.0), ("right_swing", 1.0)])
def test_phase_and_time_of_a_push_are_kept(simulate, run, phase, side):
    row = {"point": "torso", "during": phase, "share": [0.5, 0.5], "at_s": [0.5, 2.0], "force_n": [5.0, 5.0]}
    row |= {"duration_s": [0.05, 0.05], "direction": "any", "shape": "step"}
    seen = watch(pushed(simulate, torso=row), run, 6.0)
    begun = [b for a, b in pairwise(seen) if b["state"]["count"][0] > a["state"]["count"][0]]
    assert len(begun) == 2
    for moment, earliest in zip(begun, (0.5, 2.0), strict=True):
        assert earliest <= moment["clock"] < earliest + 2.0
        assert (moment["side"], moment["swinging"]) == (side, 1)


def test_random_pushes_pause_as_asked_and_point_anywhere(simulate, run):
    row = {"point": "torso", "pause_s": [0.05, 0.2], "force_n": [1.0, 2.0], "duration_s": [0.01, 0.02]}
    seen = watch(pushed(simulate, torso={**row, "direction": "any", "shape": "step"}), run, 12.0)
    starts = [b for a, b in pairwise(seen) if b["state"]["count"][0] > a["state"]["count"][0]]
    gaps = np.diff([moment["clock"] for moment in starts])
    assert len(starts) > 60
    assert gaps.min() > 0.058
    assert gaps.max() < 0.223
    directions = np.array([moment["state"]["direction"][0] for moment in starts])
    np.testing.assert_allclose(np.linalg.norm(directions, axis=1), 1.0)
    assert np.abs(directions.mean(axis=0)).max() < 0.3
    np.testing.assert_allclose((directions**2).mean(axis=0), 1 / 3, atol=0.12)
    sizes = np.array([moment["state"]["size"][0] for moment in starts])
    assert 1.0 <= sizes.min() < 1.1 < 1.9 < sizes.max() <= 2.0


def test_sines_are_the_sum_of_their_lines_on_their_joint_alone(simulate, run):
    """Equation: size times the sum of share sin(2 pi f t + phase), t from the push's start."""
    lines = {"frequency_hz": [2.0, 11.0], "phase_deg": [0.0, 90.0], "share": [1.0, 0.5]}
    row = {"joint": "LL4", "at_s": [0.0], "torque_nm": [3.0, 3.0], "duration_s": [1.0, 1.0], "shape": "sines"}
    other = {**row, "joint": "LL2", "sines": {"frequency_hz": [5.0], "phase_deg": [0.0], "share": [1.0]}}
    seen = watch(pushed(simulate, knee={**row, "sines": lines}, hip=other), run, 3.2)
    torque = np.array([moment["tau_push"] for moment in seen])
    on = np.flatnonzero([moment["pushed"] for moment in seen])
    inner = on[1:-1]  # whole samples, means over two ticks: 1 and 0.5 ms before the clock that is read
    middle = np.array([seen[row]["clock"] - seen[row]["state"]["start"][0] for row in inner]) - 0.00075
    expected = 3.0 * (np.sin(2 * np.pi * 2.0 * middle) + 0.5 * np.cos(2 * np.pi * 11.0 * middle))
    np.testing.assert_allclose(torque[inner, 6 + 3], expected, atol=1e-3)
    np.testing.assert_allclose(torque[inner, 6 + 1], 3.0 * np.sin(2 * np.pi * 5.0 * middle), atol=1e-3)
    assert len(on) == pytest.approx(1000, abs=2)
    assert not np.delete(torque, [6 + 1, 6 + 3], axis=1).any()
    assert not np.delete(torque, on, axis=0).any()


def test_torque_of_pushes_is_the_external_torque_where_nothing_touches(simulate, run):
    row = {"point": "left_knee_front", "during": "left_swing", "share": [0.4, 0.4], "at_s": [0.0]}
    row |= {"force_n": [20.0, 20.0], "duration_s": [0.05, 0.05], "direction": "backward", "shape": "step"}
    seen = watch(pushed(simulate, knee=row), run, 4.0)
    on = [moment for moment in seen if moment["pushed"]]
    assert on
    for moment in on:
        np.testing.assert_allclose(moment["tau_push"][6:12], moment["tau_ext"][6:12], atol=1e-4)
    assert np.abs(on[20]["tau_push"][LL3]) > 2.0
    assert not any(moment["tau_push"].any() for moment in seen if not moment["pushed"])


def test_push_of_the_knee_goes_against_its_front(simulate, run):
    row = {"point": "left_knee_front", "at_s": [0.0], "force_n": [9.0, 9.0], "duration_s": [1.0, 1.0]}
    simulator = pushed(simulate, knee={**row, "direction": "backward", "shape": "step"})
    forward = None
    while not simulator.pushes.state["active"][0]:
        forward = simulator.world.data.body("L_Knee_Link").xmat.reshape(3, 3)[:, 0].copy()
        run(simulator, 0.001)
    assert forward is not None
    np.testing.assert_allclose(simulator.pushes.state["direction"][0], -forward, atol=0.01)


def test_words_of_the_configuration_are_all_known():
    assert set(get_args(Phase)) == set(PHASES)
    assert set(get_args(Direction)) == set(DIRECTIONS)
    assert set(get_args(Push.model_fields["shape"].annotation)) == set(SHAPES)


@pytest.mark.parametrize(("force", "seconds"), [(200.0, 0.1), (150.0, 0.4)])
def test_an_impactor_pushes_a_wall_as_hard_and_as_long_as_it_says(force, seconds):
    """The closed form of a mass that meets a wall on a spring: half a sine of F and T."""
    p, place, dt, felt = np.zeros(1, STATE)[0], np.array([1.0, 0.0, 0.0]), 0.0005, []
    p["size"], p["start"], p["end"], p["direction"], p["place"] = force, 0.0, seconds, [-1.0, 0.0, 0.0], place
    meet(p, 20.0, place, dt)
    while not felt or felt[-1] >= 0.0:
        felt.append(hit(p, 20.0, place, dt))
    assert max(felt) == pytest.approx(force, rel=0.02)
    assert len(felt) * dt == pytest.approx(seconds, rel=0.02)
    assert sum(felt) * dt == pytest.approx(2.0 / np.pi * force * seconds, rel=0.02)
    away = float(p["speed"])
    assert hit(p, 20.0, place, dt) < 0.0
    assert p["speed"] == away  # once they have parted nothing holds it


def test_an_impactor_pushes_less_a_point_that_gives_way():
    """A free mass as large as the impactor's takes it over: half the mass acts on the spring."""
    p, dt, mass, felt, x, rate = np.zeros(1, STATE)[0], 0.0005, 20.0, [0.0], 0.0, 0.0
    p["size"], p["end"], p["direction"] = 200.0, 0.1, [1.0, 0.0, 0.0]
    meet(p, mass, np.zeros(3), dt)
    while felt[-1] >= 0.0:
        felt.append(hit(p, mass, np.array([x, 0.0, 0.0]), dt))
        rate += felt[-1] / mass * dt
        x += rate * dt
    assert max(felt) == pytest.approx(200.0 / np.sqrt(2.0), rel=0.02)
    assert len(felt) * dt == pytest.approx(0.1 / np.sqrt(2.0), rel=0.03)


def test_an_impactor_stays_until_it_has_parted():
    """At its start it just touches the point, up to rounding; it must not be gone then."""
    rng = np.random.default_rng(7)
    for _ in range(200):
        law, p = np.zeros(1, LAW), np.zeros(1, STATE)
        law["mass"], law["timed"] = 20.0, 1
        place, towards = rng.normal(size=3), rng.normal(size=3)
        p["size"], p["start"], p["end"], p["active"], p["place"] = 200.0, 1.0, 1.1, 1, place
        p["direction"] = towards / np.linalg.norm(towards)
        pushes = Pushes(law, np.full((1, 2), np.inf), np.zeros((1, 0, 3)), p)
        meet(p[0], 20.0, place, 0.0005)
        forces = [advance_impactor(pushes, 0, 1.0 + 0.0005 * k, place, 0.0005, rng) for k in range(150)]
        assert p["active"][0] == 1
        assert min(forces[1:]) > 0.0


def test_an_impactor_hits_the_swinging_knee_and_leaves_it(simulate, run):
    """The force is part of the external torque, begins and ends at zero, and comes once for each of its times."""
    row = {"point": "left_knee_front", "during": "left_swing", "share": [0.4, 0.4], "at_s": [0.0, 2.5]}
    row |= {"force_n": [100.0, 100.0], "duration_s": [0.1, 0.1], "direction": "backward", "shape": "impactor"}
    seen = watch(pushed(simulate, knee={**row, "impactor_kg": 20.0}), run, 6.5)
    torque = np.array([moment["tau_push"][LL3] for moment in seen])
    flags = np.array([moment["pushed"] for moment in seen])
    starts = np.flatnonzero(np.diff(flags, prepend=0.0) > 0)
    assert len(starts) == 2
    assert (torque[flags == 0] == 0.0).all()
    assert 0.02 < flags.sum() / 1000 / 2 < 0.15
    assert 5.0 < np.abs(torque).max() < 60.0

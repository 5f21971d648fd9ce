"""Drives of the surrogate robot: each part of their friction, by itself and in its published form."""

from collections.abc import Callable

import numpy as np
import pytest

from mobnet.simulation.drives import Drives, drive, no_drives, reset_drives

DT = 0.0005
PLAIN = {  # a drive without any friction, and quantities by which nothing is divided
    "constant": 1.0, "lag": 1e-6, "rotor": 0.4, "stiffness": 2e4, "damping": 20.0, "presliding": 0.004,
    "stribeck": 0.02, "back": 1.0, "warm_s": 1000.0,
}  # fmt: skip
Drive = Callable[..., Drives]


@pytest.fixture
def made():
    """A function of numbers of LAW -> one drive with them, at rest."""

    def make(running_s=0.0, rate=0.0, **law):
        drives = no_drives(1)._replace(hidden=1, wanted=np.zeros((1, int(law.get("delay", 0)) + 1)))
        for name, value in {**PLAIN, **law}.items():
            drives.law[name] = value
        reset_drives(drives, np.zeros(1), np.full(1, rate), running_s)
        return drives

    return make


def push(drives, torque, seconds, q=0.0, rate=0.0):
    """Drive a link that is held, or that moves at a rate [rad/s]; return the torques on it [N m]."""
    link, reported, out = np.zeros(1), np.zeros(1), []
    for _ in range(round(seconds / DT)):
        drive(drives, np.array([torque]), np.array([q]), np.array([rate]), DT, link, reported)
        q += rate * DT
        out.append(float(link[0]))
    return out


def held(drives, rate, load, turn=0.5):
    """Return the friction [N m] against a rotor that keeps a rate [rad/s] over an angle [rad] under a spring's torque.

    The link is moved along so that the gear transmits `load` [N m]; what the motor has to give beyond is friction.
    """
    law, s = drives.law[0], drives.state[0]
    link, reported, torques = np.zeros(1), np.zeros(1), []
    for _ in range(round(turn / abs(rate) / DT)):
        s["rate"] = rate
        before = float(s["angle"])
        q = before - load / law["stiffness"]
        drive(drives, np.zeros(1), np.array([q]), np.array([rate]), DT, link, reported)
        # what the rotor lost over the step, without the spring's own torque
        lost = law["rotor"] * (rate - float(s["rate"])) / DT - load
        torques.append(lost)
    return float(np.mean(torques[len(torques) // 2 :]))


def test_a_drive_without_friction_passes_its_torque_on(made):
    """On a link that is held, the torque arrives behind the spring, which bends by torque over stiffness."""
    drives = made(damping=150.0)
    assert push(drives, 30.0, 0.5)[-1] == pytest.approx(30.0, rel=1e-3)
    assert drives.state["angle"][0] == pytest.approx(30.0 / PLAIN["stiffness"], rel=1e-3)


def test_torque_constant_and_current_loop(made):
    """The true torque is the reported one times the constant; the report follows after a delay with a time constant."""
    drives, reported = made(constant=1.05, lag=0.002, delay=2, damping=150.0), []
    link = np.zeros(1)
    for _ in range(1000):
        told = np.zeros(1)
        drive(drives, np.array([10.0]), np.zeros(1), np.zeros(1), DT, link, told)
        reported.append(float(told[0]))
    assert link[0] == pytest.approx(10.5, rel=1e-3)
    assert reported[-1] == pytest.approx(10.0, rel=1e-6)
    # The torque that is desired at a step stands for all steps before the first, so the delay is one of later changes.
    assert reported[0] == pytest.approx(10.0 * (1.0 - np.exp(-DT / 0.002)), rel=1e-6)
    drive(drives, np.array([0.0]), np.zeros(1), np.zeros(1), DT, link, told := np.zeros(1))
    assert told[0] == pytest.approx(10.0, rel=1e-6)
    decay = []
    for _ in range(10):
        drive(drives, np.array([0.0]), np.zeros(1), np.zeros(1), DT, link, told := np.zeros(1))
        decay.append(float(told[0]))
    assert decay[5] / decay[4] == pytest.approx(np.exp(-DT / 0.002), rel=1e-6)


@pytest.mark.parametrize("rate", [-0.5, 0.5])
def test_coulomb_and_viscous_friction(made, rate):
    """Far from rest: Coulomb friction, apart for each direction, and a part that grows with the rate."""
    drives = made(coulomb=6.0, direction=0.1, viscous=4.0)
    sign = np.sign(rate)
    assert held(drives, rate, 0.0) == pytest.approx(sign * 6.0 * (1.0 + 0.1 * sign) + 4.0 * rate, rel=0.02)


def test_friction_is_larger_near_rest(made):
    slow, fast = (held(made(coulomb=6.0, static=0.3), rate, 0.0, turn=0.1) for rate in (0.002, 0.5))
    assert slow / fast == pytest.approx(1.0 + 0.3 * np.exp(-0.002 / 0.02), rel=0.01)


@pytest.mark.parametrize(("rate", "load", "share"), [
    (0.5, 80.0, 0.2), (-0.5, -80.0, 0.2), (0.5, -80.0, 0.3), (-0.5, 80.0, 0.3),
])  # fmt: skip
def test_friction_under_load_depends_on_which_side_drives(made, rate, load, share):
    """Of the transmitted torque, the share `load` where the motor drives, `back` times as much where the load does."""
    found = held(made(load=0.2, back=1.5), rate, load)
    assert found == pytest.approx(np.sign(rate) * share * 80.0, rel=0.02)


def test_friction_varies_along_a_turn_and_cogging_does_not_brake(made):
    """The mean over whole waves of ripple is Coulomb friction; a cogging torque takes no energy."""
    turn = 4 * 2 * np.pi / 200
    rippled = held(made(coulomb=6.0, ripple=0.1, ripple_waves=200.0), 0.2, 0.0, turn)
    assert rippled == pytest.approx(6.0, rel=0.02)
    cogged = held(made(cogging=1.5, cogging_waves=600.0), 0.2, 0.0, turn)
    assert cogged == pytest.approx(0.0, abs=0.05)


def test_a_warm_gear_rubs_less(made):
    """By its share, with its time constant; friction under load stays."""
    law = {"coulomb": 6.0, "viscous": 4.0, "warm": 0.2, "warm_s": 1000.0}
    cold, half, warm = (held(made(running_s=seconds, **law), 0.5, 0.0, 0.1) for seconds in (0.0, 1000.0, 1e6))
    assert warm / cold == pytest.approx(0.8, rel=2e-3)  # viscous friction is taken at the end of a step
    assert half / cold == pytest.approx(1 - 0.2 * (1 - np.exp(-1)), rel=2e-3)


def test_a_small_torque_bends_the_friction_and_a_large_one_breaks_away(made):
    """Below Coulomb friction a free rotor comes to rest within some presliding angles, above it runs away."""

    def free(torque):
        drives, link, reported = made(coulomb=6.0, viscous=4.0, stiffness=100.0, damping=0.0), np.zeros(1), np.zeros(1)
        for _ in range(2000):
            q = np.array([drives.state["angle"][0]])  # the link follows, so that the gear transmits nothing
            drive(drives, np.array([torque]), q, np.array([drives.state["rate"][0]]), DT, link, reported)
        return float(drives.state["angle"][0])

    assert 0.0 < free(3.0) < 5 * PLAIN["presliding"]
    assert free(12.0) > 100 * PLAIN["presliding"]


def test_presliding_takes_energy(made):
    """Back and forth by less than a presliding angle: friction comes back on another way than it went."""
    drives, work = made(coulomb=6.0), 0.0
    s, link, reported = drives.state[0], np.zeros(1), np.zeros(1)
    for k in range(8000):
        rate = 0.02 * np.cos(2 * np.pi * 2.0 * k * DT)
        s["rate"] = rate
        drive(drives, np.zeros(1), np.array([float(s["angle"])]), np.array([rate]), DT, link, reported)
        work += PLAIN["rotor"] * (rate - float(s["rate"])) * rate
    assert work > 0.0
    assert np.abs(s["bend"]) < 1.0


def test_the_cable_acts_on_the_link(made):
    torque = push(made(cable=2.0, cable_phase=0.3, damping=150.0), 0.0, 0.5, q=0.0)[-1]
    assert torque == pytest.approx(2.0 * np.sin(0.3), rel=1e-3)

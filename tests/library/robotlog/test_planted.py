"""Mistakes planted into an arm's log are named, and no other joint or mistake: 14 of them, on two kinds of torques.

The arm is a made-up stand-in for a real one: its links weigh a tenth more than its table says, and its drives have
friction and rotor inertia that the table lacks. A UR10e's own log is tried where there is one (`made_ur10e`).
"""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest
from made_mistakes import PLANTED, Log, fault_of
from made_ur10e import GAINS, UR10E, ur10e_rows, write_ur10e_table

from mobnet.formats.loading import load_section
from mobnet.formats.robot import RobotTable
from mobnet.robot.description import describe
from mobnet.robot.dynamics import inverse_dynamics
from mobnet.robot.nominal import NominalModel
from mobnet.robotlog.observe import observe_log

RATE_HZ, SECONDS, WAVES = 100.0, 40.0, 6
G = 9.81
HEAVIER = 1.1  # links than in the table
DRY, VISCOUS, ROTOR = 0.06, 0.05, 0.01  # shares of a motor's largest torque: [N m], [N m s/rad], [N m s^2/rad]
NOISE = {"q": 1e-5, "v": 2e-3, "torque": 2e-3}  # [rad], [rad/s], share of a motor's largest torque
CARRIED_M = (0.0, 0.0, 0.2)  # in the frame of the last link
MIDDLE = (0.0, -0.6, 0.0, -1.6, 0.0, 1.8, 0.0)  # pose about which the arm moves [rad]
REAL = "20_02_12-40sec_12harm"  # log of a UR10e
KINDS = ("of the controller", "of currents")  # the first without friction


@pytest.fixture(scope="module")
def panda():
    return describe(load_section(Path("configs/robots/panda.yaml"), RobotTable))


def arm_log(robot, friction, carried_kg=0.0, down=(0.0, 0.0, -1.0), slower=1.0):
    """Return a log of the stand-in, which may have friction and carry a mass beyond its last link.

    Gravity acts along a direction in the axes of its table; motion may be so many times slower.
    """
    rng, t = np.random.default_rng(5), np.arange(0, SECONDS, 1 / RATE_HZ)
    joints, limits = robot.layout.nu, robot.torque_limits
    rate, phase = 2 * np.pi * rng.uniform(0.05, 0.5, (WAVES, joints)) / slower, rng.uniform(0, 6, (WAVES, joints))
    size, angle = rng.uniform(0.08, 0.2, (WAVES, joints)), rate * t[:, None, None] + phase
    q = MIDDLE + (size * np.sin(angle)).sum(axis=1)
    v = (size * rate * np.cos(angle)).sum(axis=1)
    a = -(size * rate**2 * np.sin(angle)).sum(axis=1)
    heavier = NominalModel(robot, mass_ratio=HEAVIER)
    heavier.model.gravity.linear = G * np.array(down)
    if carried_kg:
        load = pin.Inertia(carried_kg, np.array(CARRIED_M), np.zeros((3, 3)))
        heavier.model.appendBodyToJoint(joints, load, pin.SE3.Identity())
    torque = np.array([inverse_dynamics(heavier, *row) for row in zip(q, v, a, strict=True)])
    if friction:
        torque += limits * (DRY * np.tanh(v / 0.02) + VISCOUS * v + ROTOR * a)
    noise = {name: spread * rng.normal(size=q.shape) for name, spread in NOISE.items()}
    read = q + noise["q"], v + noise["v"], torque + limits * noise["torque"]
    return Log(*read, RATE_HZ, base=0, shoulder=1, elbow=3)


@pytest.fixture(scope="module")
def arm_logs(panda):
    """Return a log of the stand-in by kind of torque."""
    return {kind: arm_log(panda, friction=kind == KINDS[1]) for kind in KINDS}


@pytest.fixture
def observed(panda, settings, tmp_path):
    """Return a function of a log that observes it."""

    def observe(log, robot=panda):
        log.table(panda.layout.actuated).to_parquet(tmp_path / "log.parquet")
        return observe_log(tmp_path / "log.parquet", robot, None, "sample", 100.0, 9.81, settings.robotlog)

    return observe


def test_a_clean_log_says_what_explains_its_residual(arm_logs, panda, observed):
    found = observed(arm_logs["of currents"])
    assert found.hints == ()
    numbers = {}
    for line in found.explained:
        if match := re.match(r"(\w+): friction of (\S+) N m .* explain (\d+)% of its square", line):
            numbers[match[1]] = float(match[2]), float(match[3])
    dry = dict(zip(panda.layout.actuated, DRY * panda.torque_limits, strict=True))
    assert len(numbers) >= 5
    for joint, (friction, explained) in numbers.items():
        assert abs(friction / dry[joint] - 1) < 0.3
        assert explained > 60


def test_a_mass_that_the_table_lacks_is_named(panda, observed):
    (hint,) = observed(arm_log(panda, friction=True, carried_kg=4.0)).hints
    found = re.search(r"a mass of ([\d.]+) kg at .* m of (\w+), which the table lacks", hint)
    assert found, hint
    assert 3.5 < float(found[1]) < 6.0  # the links are heavier than in the table, too


@pytest.mark.parametrize("name", PLANTED)
@pytest.mark.parametrize("kind", KINDS)
def test_a_planted_mistake_is_named_and_nothing_else(kind, name, arm_logs, panda, observed):
    log = arm_logs[kind]
    hints = observed(PLANTED[name].spoil(log)).hints
    assert fault_of(name, log, panda.layout.actuated, hints) == ""


@pytest.mark.parametrize(
    ("place", "down"),
    [
        ("on a wall", (0.0, 1.0, 0.0)),
        ("from a ceiling", (0.0, 0.0, 1.0)),
        ("on a slope", (np.sin(0.35), 0.0, -np.cos(0.35))),
    ],
)
@pytest.mark.parametrize("kind", KINDS)
def test_a_base_that_hangs_otherwise_is_named_and_what_the_hint_says_mends_it(kind, place, down, panda, observed):
    log = arm_log(panda, friction=kind == KINDS[1], down=down)
    (hint,) = observed(log).hints
    assert f"gravity comes from another side than in the table: along ({', '.join(f'{x:.2f}' for x in down)})" in hint
    assert f", as {place};" in hint
    quat = tuple(map(float, re.search(r"`quat: \[(.*)\]`", hint)[1].split(", ")))
    first = panda.bodies[0].model_copy(update={"quat": quat})
    mended = replace(panda, bodies=(first, *panda.bodies[1:]))
    assert observed(log, mended).hints == ()


@pytest.mark.parametrize("joint", ["shoulder", "elbow"])
@pytest.mark.parametrize("kind", KINDS)
def test_a_wrong_torque_constant_is_named_and_no_missing_mass(kind, joint, arm_logs, panda, observed):
    log = arm_logs[kind]
    k = getattr(log, joint)
    size = np.ones(panda.layout.nu)
    size[k] = 1 / 0.7
    found = observed(replace(log, torque=size * log.torque))
    (line,) = [line for line in (*found.hints, *found.explained) if "friction of" not in line]
    factor = re.match(rf"{panda.layout.actuated[k]}: tau_motor is ([\d.]+) times .*: a wrong torque constant\?", line)
    assert float(factor[1]) == pytest.approx(HEAVIER / 0.7, rel=0.02)


@pytest.mark.parametrize("joints", [None, (1, 3)])
def test_all_torques_are_named_where_no_joint_speaks_against_it(joints, panda, observed):
    """In slow motion without friction only the joints that carry the arm tell a sign."""
    log = arm_log(panda, friction=False, slower=20.0)
    sign = np.ones(panda.layout.nu)
    sign[list(joints or range(panda.layout.nu))] = -1.0
    (hint,) = observed(replace(log, torque=sign * log.torque)).hints
    all_of_them = ", and so may be that of all joints: none speaks against it"
    assert "tau_motor is of the wrong sign" in hint
    assert (all_of_them in hint) == (joints is None)


if UR10E is not None:

    @pytest.fixture(scope="module")
    def ur10e(tmp_path_factory):
        path = tmp_path_factory.mktemp("ur10e") / "arm.yaml"
        write_ur10e_table(path)
        return describe(load_section(path, RobotTable))

    @pytest.mark.parametrize("name", PLANTED)
    @pytest.mark.parametrize("kind", KINDS)
    def test_a_mistake_planted_into_a_real_log_is_named(kind, name, ur10e, settings, tmp_path):
        columns = ur10e_rows(REAL)
        columns = columns[np.diff(columns[:, 0], prepend=-np.inf) > 0]
        t = np.arange(columns[0, 0], columns[-1, 0], 1 / RATE_HZ)[: round(SECONDS * RATE_HZ)]
        q, v, current, _, target = np.split(
            np.stack([np.interp(t, columns[:, 0], x) for x in columns.T[1:]], axis=1), 5, 1
        )
        torque = target if kind == KINDS[0] else current * GAINS
        log, joints = Log(q, v, torque, RATE_HZ, base=0, shoulder=1, elbow=2), ur10e.layout.actuated
        PLANTED[name].spoil(log).table(joints).to_parquet(tmp_path / "log.parquet")
        hints = observe_log(tmp_path / "log.parquet", ur10e, None, "sample", 100.0, 9.81, settings.robotlog).hints
        assert fault_of(name, log, joints, hints) == ""

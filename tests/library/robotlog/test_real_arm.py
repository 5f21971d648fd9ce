"""What `identify` gains on an arm whose torques are motor currents: a UR10e's public logs, or a stand-in for them.

The logs are those of `made_ur10e`. In two of them a person pushes the standing arm, at times that were read off the
currents.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from made_ur10e import GAINS, UR10E, ur10e_rows, write_ur10e_table

from mobnet.detection.chain import low_passed, make_chain
from mobnet.estimation.observer import RobotObserver
from mobnet.formats.loading import load_section
from mobnet.formats.log_map import LogMap
from mobnet.robot.dynamics import inverse_dynamics
from mobnet.robot.given import given_robot
from mobnet.robot.nominal import NominalModel
from mobnet.robotlog.identify import main as identify
from mobnet.robotlog.observe import converted_log

ARM = Path(__file__).parents[2] / "data" / "arm.yaml"
KNOWN = (
    "20_02_12-50sec_12harm", "20_02_19_14harm50sec", "20_02_10-30sec_12harm", "20_02_06-20sec_10harm",
    "20_02_05-20sec_12harm", "20_02_10-20sec_7harm",
)  # fmt: skip
CALM = (
    "20_02_12-40sec_12harm", "20_02_19_15harm50sec", "20_01_31-unload", "20_02_05-20sec_8harm", "20_02_06-20sec_5harm",
    "19_12_23_free",
)  # fmt: skip
PUSHES = {
    "20_01_22-push_pose_1": [(202.3, 203.3), (205.2, 206.4), (208.9, 210.0), (212.4, 213.8)],
    "20_01_22-push_pose_2": [
        (262.2, 263.1), (264.2, 265.4), (266.6, 267.6), (269.7, 270.9), (273.2, 274.2), (275.9, 276.6)
    ],
}  # fmt: skip
SETTLE_S, BEFORE_S, AFTER_S = 0.5, 0.3, 0.5  # of the observer, and of a push
STAND_IN_HZ = 94.0


def write_csv(path, rows, joints):
    """Write rows of time, positions, velocities and currents, with the header that the published files lack."""
    names = ["t", *(f"{signal}{k}" for signal in ("q", "v", "i") for k in range(1, joints + 1))]
    np.savetxt(path, np.array(rows)[:, : len(names)], "%.4f", ",", header=",".join(names), comments="")


def write_map(path, gains):
    columns = {signal: [f"{signal}{k + 1}" for k in range(len(gains))] for signal in "qvi"}
    lines = ["clock: {column: t}", "rate_hz: 100", f"q: {{columns: {columns['q']}}}", f"v: {{columns: {columns['v']}}}"]
    path.write_text("\n".join([*lines, f"tau_motor: {{columns: {columns['i']}, unit: A, scale: {gains}}}"]) + "\n")


def judged(table, folder, calm, pushes, settings):
    """Return the observer's error in calm logs (nu,) [N m], pushes that are found, and false alarms beside them.

    A threshold is the largest number in the calm logs, behind the low-pass of a detector.
    """
    robot, meaning = given_robot(table, settings.robot), load_section(folder / "map.yaml", LogMap)
    chain = make_chain(settings.detection.low_pass_hz, 0.0, 100.0, np.ones((1, robot.layout.nu)))

    def watched(name):
        found = converted_log(folder / f"{name}.csv", robot.layout, meaning, settings.robotlog)
        nominal = NominalModel(robot, gravity_m_s2=settings.plant.gravity_m_s2)
        read, settle = found.recording, round(SETTLE_S * 100.0)
        residual = RobotObserver(nominal, 100.0, read.rate_hz, "sample").residual(read.sensed)[settle:]
        behind = np.zeros_like(residual)
        low_passed(chain.pole, residual, behind)
        return residual, np.abs(behind), found.time_s[settle:]

    logs = [watched(name) for name in calm]
    size = np.sqrt(np.square(np.concatenate([residual for residual, _, _ in logs])).mean(axis=0))
    thresholds = np.max([behind.max(axis=0) for _, behind, _ in logs], axis=0)
    found, false = 0, 0
    for name, spans in pushes.items():
        _, behind, t = watched(name)
        above = (behind > thresholds).any(axis=1)
        found += sum(bool(above[(t > start) & (t < end)].any()) for start, end in spans)
        near = np.any([(t > start - BEFORE_S) & (t < end + AFTER_S) for start, end in spans], axis=0)
        false += int(above[~near].sum())
    return size, found, false


@pytest.fixture(scope="module")
def ur10e(tmp_path_factory):
    """A folder with the table, the logs that are used and their map."""
    folder = tmp_path_factory.mktemp("ur10e")
    for name in (*KNOWN, *CALM, *PUSHES):
        write_csv(folder / f"{name}.csv", ur10e_rows(name), 6)
    write_map(folder / "map.yaml", GAINS)
    write_ur10e_table(folder / "arm.yaml")
    return folder


if UR10E is not None:

    @pytest.mark.slow
    def test_on_a_ur10e_friction_that_is_identified_makes_way_for_pushes(ur10e, settings, monkeypatch):
        monkeypatch.chdir(ur10e)
        before, found_before, _ = judged(Path("arm.yaml"), ur10e, CALM, PUSHES, settings)
        words = ["--robot", "arm.yaml", "--map", "map.yaml", "--out", "known.yaml"]
        assert identify([*(f"{name}.csv" for name in KNOWN), *words]) == 0
        after, found, false = judged(Path("known.yaml"), ur10e, CALM, PUSHES, settings)
        assert before[0] > 34.0
        assert after[0] <= 4.5
        assert after[1] <= 12.0
        assert (after < before).all()
        assert found >= 7 > found_before
        assert false == 0


@pytest.fixture(scope="module")
def stand_in(tmp_path_factory, arm):
    """A folder like that of the UR10e: currents with friction and rotors in them at 94 Hz, four digits, and pushes."""
    folder, gains = tmp_path_factory.mktemp("stand_in"), [10.0, 8.0]
    rotors = tuple(row.model_copy(update={"armature": 0.5}) for row in arm.joints)
    true = NominalModel(replace(arm, joints=rotors), gravity_m_s2=9.81)

    def write(name, seed, seconds, spans=()):
        rng, t = np.random.default_rng(seed), np.arange(0, seconds, 1 / STAND_IN_HZ)[:, None]
        rate, size = 2 * np.pi * rng.uniform(0.05, 0.5, (4, 1, 2)), rng.uniform(0.1, 0.3, (4, 1, 2))
        size *= 0.0 if spans else 1.0  # it stands while it is pushed
        angle = rate * t + rng.uniform(0, 6, (4, 1, 2))
        waves = np.sin(angle), rate * np.cos(angle), -np.square(rate) * np.sin(angle)
        q, v, a = ((size * part).sum(axis=0) for part in waves)
        tau = np.array([inverse_dynamics(true, *row) for row in zip(q, v, a, strict=True)])
        tau += np.array([8.0, 5.0]) * np.tanh(v / 0.02) + np.array([4.0, 3.0]) * v
        for start, end in spans:
            tau[round(start * STAND_IN_HZ) : round(end * STAND_IN_HZ), 1] += 3.0
        rows = np.hstack([t, q, v + 2e-4 * rng.normal(size=v.shape), (tau + 0.2 * rng.normal(size=tau.shape)) / gains])
        write_csv(folder / f"{name}.csv", rows, 2)

    for k, name in enumerate(("known_1", "known_2", "calm_1", "calm_2")):
        write(name, k, 50.0)
    write("pushed", 9, 12.0, [(3.0, 4.0), (6.0, 7.0), (9.0, 10.0)])
    write_map(folder / "map.yaml", gains)
    (folder / "arm.yaml").write_text(ARM.read_text())
    return folder


def test_on_a_stand_in_friction_that_is_identified_makes_way_for_pushes(stand_in, settings, monkeypatch):
    monkeypatch.chdir(stand_in)
    calm, pushes = ("calm_1", "calm_2"), {"pushed": [(3.0, 4.0), (6.0, 7.0), (9.0, 10.0)]}
    before, found_before, _ = judged(Path("arm.yaml"), stand_in, calm, pushes, settings)
    words = ["--robot", "arm.yaml", "--map", "map.yaml", "--out", "known.yaml"]
    assert identify(["known_1.csv", "known_2.csv", *words]) == 0
    after, found, false = judged(Path("known.yaml"), stand_in, calm, pushes, settings)
    assert (after < before / 5).all()
    assert (found_before, found, false) == (0, 3, 0)

"""Friction and rotor inertia that are in a log are found, with intervals, and the observer then knows them."""

import logging
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pinocchio as pin
import pytest

from mobnet.core.errors import ConfigError, DataError
from mobnet.core.recording import Sensed, SensedRecording
from mobnet.detection.calibrate import main as calibrate
from mobnet.estimation.observer import RobotObserver
from mobnet.formats.checks.robot import robot_problems
from mobnet.formats.loading import load_section
from mobnet.formats.parts import FrictionRow
from mobnet.formats.robot import RobotTable
from mobnet.robot.description import describe
from mobnet.robot.nominal import NominalModel
from mobnet.robot.table_file import head_of, write_table
from mobnet.robotlog.detect import main as detect
from mobnet.robotlog.identify import TERMS, FreeLog, identify, main, suspicions, with_payload
from mobnet.robotlog.identifying.payload import LEAST_KG, parameters
from mobnet.robotlog.observe import main as observe

ARM = Path(__file__).parents[2] / "data" / "arm.yaml"
GRAVITY, RATE_HZ, SECONDS, WAVES = 9.81, 200.0, 120.0, 4
NOISE = {"v": 2e-3, "tau_motor": 0.03}
ROTORS, OFFSET = (0.3, 0.15), (0.2, -0.1)  # of J1 and J2 [kg m^2], [N m]
SMOOTH = {
    "J1": FrictionRow(coulomb_nm=2.0, viscous_nms=1.0, offset_nm=OFFSET[0], smoothing_rad_s=0.02),
    "J2": FrictionRow(coulomb_nm=1.0, viscous_nms=0.5, offset_nm=OFFSET[1], smoothing_rad_s=0.02),
}
BENT = {joint: row.model_copy(update={"breakaway_rad": 0.03}) for joint, row in SMOOTH.items()}
LOAD, BALL = (1.2, (0.3, 0.0, -0.12)), (1.3e-3, 1.3e-3, 1.3e-3, 0.0, 0.0, 0.0)  # [kg], [m], [kg m^2]
WITHIN = 0.05  # of the truth


@pytest.fixture(scope="module")
def bare(arm):
    """The arm as a URDF has it: without rotors."""
    return replace(arm, joints=tuple(row.model_copy(update={"armature": 0.0}) for row in arm.joints))


@pytest.fixture(scope="module")
def moved(bare):
    """Return a function of a seed and of friction that makes samples of the arm in free motion; a push, if wanted."""

    def make(seed, friction=SMOOTH, seconds=SECONDS, links=0.0, push_nm=0.0, spans=(), payload=None):
        rng, t = np.random.default_rng(seed), np.arange(0, seconds, 1 / RATE_HZ)[:, None]
        rate, size = 2 * np.pi * rng.uniform(0.1, 0.8, (WAVES, 1, 2)), rng.uniform(0.1, 0.3, (WAVES, 1, 2))
        angle = rate * t + rng.uniform(0, 6, (WAVES, 1, 2))
        q, v, a = (
            (size * part).sum(axis=0)
            for part in (np.sin(angle), rate * np.cos(angle), -np.square(rate) * np.sin(angle))
        )
        bodies = tuple(
            row.model_copy(update={"mass": own * row.mass, "inertia": tuple(own * x for x in row.inertia)})
            for row, own in zip(bare.bodies, 1 + links * rng.normal(size=len(bare.bodies)), strict=True)
        )
        if payload:
            mass, com = payload
            load = bare.bodies[-1].model_copy(
                update={"name": "load", "parent": "lower", "pos": com, "com": (0.0,) * 3, "mass": mass, "inertia": BALL}
            )
            bodies = (*bodies, load)
        rotors = (row.model_copy(update={"armature": own}) for row, own in zip(bare.joints, ROTORS, strict=True))
        true = NominalModel(replace(bare, bodies=bodies, joints=tuple(rotors)), gravity_m_s2=GRAVITY)
        tau = np.array([pin.rnea(true.model, true.data, *row) for row in zip(q, v, a, strict=True)])
        known = RobotObserver(NominalModel(replace(bare, friction=friction)), 100.0, RATE_HZ, "sample")
        tau += known.drives.run(known.drives.init(), v, np.zeros_like(v), RATE_HZ)[1]
        for start, end in spans:
            tau[round(start * RATE_HZ) : round(end * RATE_HZ)] -= push_nm
        none = np.zeros((len(t), 0))
        noisy = [x + NOISE[name] * rng.normal(size=x.shape) for name, x in (("v", v), ("tau_motor", tau))]
        return Sensed(q, noisy[0], none, noisy[1], noisy[1], none, none, none)

    return make


def recorded(sensed):
    return FreeLog(Path("log"), SensedRecording(sensed, ((0, len(sensed)),), RATE_HZ, {}), "sample")


def truth_of(friction):
    rows = friction.values()
    return {
        "coulomb": [row.coulomb_nm for row in rows], "viscous": [row.viscous_nms for row in rows],
        "offset": [row.offset_nm for row in rows], "armature": ROTORS,
    }  # fmt: skip


def test_numbers_are_within_five_per_cent_and_intervals_hold_them(bare, moved, settings):
    """Twelve draws, whose links differ from the table by 3 %: 96 intervals of 95 %."""
    held, off = list[bool](), list[float]()
    for seed in range(12):
        found, _ = identify(bare, [recorded(moved(seed, links=0.03))], TERMS, settings)
        for term, values in truth_of(SMOOTH).items():
            for fit, value in zip(found.values(), values, strict=True):
                held.append(abs(fit.factors[term] - value) <= fit.half[term])
                off += [] if term == "offset" else [abs(fit.factors[term] / value - 1)]
    assert 0.9 <= np.mean(held) <= 0.995
    assert np.quantile(off, 0.95) < WITHIN
    assert max(off) < 3 * WITHIN


def test_the_bend_is_taken_where_friction_has_one_and_not_elsewhere(bare, moved, settings):
    kinds = {}
    for friction in (SMOOTH, BENT):
        found, _ = identify(bare, [recorded(moved(1, friction))], TERMS, settings)
        kinds[friction["J1"].breakaway_rad] = [fit.sign[0] for fit in found.values()]
        for fit, value in zip(found.values(), truth_of(friction)["coulomb"], strict=True):
            assert fit.factors["coulomb"] == pytest.approx(value, rel=WITHIN)
            assert fit.explained > 0.99
    assert kinds == {None: ["smoothing"] * 2, 0.03: ["breakaway"] * 2}


def test_a_wrong_torque_constant_is_found_where_asked(bare, moved, settings):
    sensed = moved(2)
    weak = replace(sensed, tau_motor=sensed.tau_motor / 1.2)
    found, _ = identify(bare, [recorded(weak)], (*TERMS, "scale"), settings)
    for fit in found.values():
        assert 1 + fit.factors["scale"] == pytest.approx(1.2, rel=WITHIN)


def test_what_looks_wrong_with_a_log_is_told_as_observe_tells_it(bare, moved, settings):
    sensed = moved(2)
    assert suspicions(bare, [recorded(sensed)], settings) == []
    weak = replace(sensed, tau_motor=sensed.tau_motor / [1.0, 1.5])
    (line,) = suspicions(bare, [recorded(weak)], settings)
    assert re.match(r"log: J2: tau_motor is 0\.\d+ times .*: a wrong torque constant\? .* identify --scale", line)
    row = SMOOTH["J2"].model_copy(update={"scale": 1.5, "offset_nm": 0.0})
    assert suspicions(replace(bare, friction={"J2": row}), [recorded(weak)], settings) == []  # the table knows it
    (line,) = suspicions(bare, [recorded(replace(sensed, v=-sensed.v))], settings)
    assert line.startswith("log: q of J1, J2: changes by -")


def test_the_observer_steps_as_it_runs(bare, moved):
    for friction in (SMOOTH, BENT, {"J2": SMOOTH["J2"].model_copy(update={"load": 0.1, "scale": 1.1})}):
        sensed = moved(3, friction, seconds=2.0)
        observer = RobotObserver(NominalModel(replace(bare, friction=friction)), 100.0, RATE_HZ, "sample")
        state, rows = observer.init(), []
        for k in range(len(sensed)):
            state, residual = observer.step(state, sensed[k])
            rows.append(residual)
        np.testing.assert_allclose(rows, observer.residual(sensed), atol=1e-10)


def test_the_observer_explains_what_it_knows(bare, moved, arm):
    """With the true friction and rotors, only noise is left of 3 N m."""
    sensed = moved(4)
    rotors = (row.model_copy(update={"armature": own}) for row, own in zip(arm.joints, ROTORS, strict=True))
    knows = replace(bare, joints=tuple(rotors), friction=SMOOTH)
    for robot, low, high in ((bare, 1.0, 5.0), (knows, 0.0, 0.3)):
        observer = RobotObserver(NominalModel(robot, gravity_m_s2=GRAVITY), 100.0, RATE_HZ, "sample")
        size = np.sqrt(np.square(observer.residual(sensed)[100:]).mean(axis=0))
        assert (size >= low).all()
        assert (size <= high).all()


def test_a_payload_that_the_table_lacks_is_found(bare, moved, settings):
    """1.2 kg, 12 cm below the tip of the lower link; its intervals hold it, and the table has it then."""
    sensed = moved(10, payload=LOAD)
    found, carried = identify(bare, [recorded(sensed)], TERMS, settings, "lower")
    alone, none = identify(bare, [recorded(sensed)], TERMS, settings)
    assert none is None
    assert abs(carried.mass - LOAD[0]) <= carried.mass_half
    assert carried.mass == pytest.approx(LOAD[0], rel=0.1)
    for own, half, value in list(zip(carried.com, carried.com_half, LOAD[1], strict=True))[::2]:  # not along the axes
        assert abs(own - value) <= half
    for joint, fit in found.items():
        assert fit.after_nm < 0.3 * alone[joint].after_nm
    table = with_payload(load_section(ARM, RobotTable), "lower", carried)
    assert not list(robot_problems(table))
    assert [row.name for row in table.bodies] == ["wall", "upper", "lower", "payload"]
    with pytest.raises(ConfigError, match="--payload: 'wall' is not accepted; accepted: lower, upper"):
        identify(bare, [recorded(sensed)], TERMS, settings, "wall")


def test_too_short_a_log_is_refused(bare, moved, settings):
    with pytest.raises(DataError, match=r"20 s of free motion; 53\.3333 s or more are needed"):
        identify(bare, [recorded(moved(5, seconds=21.0))], TERMS, settings)


def test_a_joint_that_rests_keeps_its_numbers(bare, moved, settings):
    sensed = moved(6)
    still = replace(sensed, v=sensed.v * [1.0, 0.0])
    found, _ = identify(bare, [recorded(still)], TERMS, settings)
    assert list(found) == ["J1"]


def write(path, sensed):
    columns = {"time": np.arange(len(sensed)) / RATE_HZ}
    columns |= {
        f"{name}.{joint}": getattr(sensed, name)[:, k]
        for name in ("q", "v", "tau_motor")
        for k, joint in enumerate(("J1", "J2"))
    }
    pd.DataFrame(columns).to_csv(path, index=False)


@pytest.fixture(scope="module")
def chain(moved, tmp_path_factory):
    """A folder with a table without rotors, logs, the identified table, and what was observed with both tables."""
    folder = tmp_path_factory.mktemp("identify")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        text = ARM.read_text().replace("armature: 0.1,", "armature: 0.0,").replace("armature: 0.05,", "armature: 0.0,")
        Path("arm.yaml").write_text(text)
        write("train.csv", moved(7, seconds=90.0))
        write("free.csv", moved(8, seconds=220.0))
        write("new.csv", moved(9, seconds=20.0, push_nm=1.5, spans=((5.0, 6.0), (10.0, 11.0), (15.0, 16.0))))
        assert observe(["train.csv", "--robot", "arm.yaml", "--out", "train"]) == 0
        assert main(["train", "--robot", "arm.yaml", "--out", "known.yaml"]) == 0
        for table in ("arm", "known"):
            words = ["--robot", f"{table}.yaml"]
            assert observe(["free.csv", *words, "--out", f"free_{table}"]) == 0
            assert calibrate([f"free_{table}", *words, "--out", f"{table}_thresholds.yaml"]) == 0
            words += ["--thresholds", f"{table}_thresholds.yaml", "--out", f"new_{table}"]
            assert detect(["new.csv", *words]) == 0
    return folder


@pytest.mark.slow
def test_a_folder_becomes_a_table_with_the_comments_of_the_first_one(chain):
    table = load_section(chain / "known.yaml", RobotTable)
    plain = load_section(chain / "arm.yaml", RobotTable)
    for joint, row in SMOOTH.items():
        assert table.friction[joint].coulomb_nm == pytest.approx(row.coulomb_nm, rel=WITHIN)
    np.testing.assert_allclose([row.armature for row in table.joints], ROTORS, rtol=WITHIN)
    assert table.bodies == plain.bodies
    first, second, *_ = (chain / "known.yaml").read_text().splitlines()
    assert first == (chain / "arm.yaml").read_text().splitlines()[0]
    assert second == "# friction and armature: from train, by ./reproduce identify."


@pytest.mark.slow
def test_a_urdf_becomes_a_table_with_notes_of_what_it_does_not_say(chain, tmp_path):
    urdf = ARM.with_suffix(".urdf")
    assert main([str(chain / "train"), "--robot", str(urdf), "--out", str(tmp_path / "known.yaml")]) == 0
    table = load_section(tmp_path / "known.yaml", RobotTable)
    assert table.friction.keys() == {"J1", "J2"}
    head = head_of(tmp_path / "known.yaml")
    assert "torque of J2: not in the file, 100 N m is taken" in head
    assert any(line.startswith("friction and armature: from train, by ") for line in head)


@pytest.mark.slow
def test_pushes_are_told_from_friction_that_was_identified(chain):
    flags = {
        table: [int(start) for start in pd.read_csv(chain / f"new_{table}" / "flags.csv").start_s]
        for table in ("arm", "known")
    }
    assert flags["known"] == [5, 10, 15]
    assert flags["arm"] != [5, 10, 15]  # some are missed, or some flags are false


@pytest.mark.slow
def test_what_was_made_with_another_table_is_refused(chain, monkeypatch, caplog):
    monkeypatch.chdir(chain)
    assert calibrate(["free_arm", "--robot", "known.yaml"]) == 1
    assert "free_arm: made with friction and armature none, and the table of --robot has " in caplog.messages[-1]
    assert detect(["new.csv", "--robot", "arm.yaml", "--thresholds", "known_thresholds.yaml"]) == 1
    assert "known_thresholds.yaml: made with friction and armature " in caplog.messages[-1]


@pytest.mark.slow
def test_a_log_is_taken_as_a_folder_is_and_a_table_is_not_replaced(chain, monkeypatch, caplog):
    monkeypatch.chdir(chain)
    caplog.set_level(logging.INFO)
    assert main(["train.csv", "--robot", "arm.yaml", "--out", "again.yaml"]) == 0
    assert (
        load_section(Path("again.yaml"), RobotTable).friction == load_section(Path("known.yaml"), RobotTable).friction
    )
    assert main(["train.csv", "--robot", "arm.yaml", "--out", "again.yaml"]) == 1
    assert caplog.messages[-1] == "again.yaml: exists already; accepted: another --out, or --force"


def test_a_table_without_friction_has_the_digest_that_it_had(arm_table):
    """By this digest jobs are made again: that of the test's arm at the commit before the key existed."""
    assert dict(arm_table.__repr_args__())["digest"] == "01d1e4d6c240170d"
    known = arm_table.model_copy(update={"friction": SMOOTH})
    assert dict(known.__repr_args__())["digest"] != "01d1e4d6c240170d"
    assert describe(arm_table).drives is None
    assert describe(known).drives is not None


@pytest.mark.parametrize("name", ["tocabi", "g1", "panda"])
def test_a_table_that_is_written_is_the_table_that_was_read(name, tmp_path):
    source = ARM.parents[2] / "configs" / "robots" / f"{name}.yaml"
    table = load_section(source, RobotTable)
    write_table(tmp_path / "again.yaml", table, head_of(source))
    assert load_section(tmp_path / "again.yaml", RobotTable) == table
    assert (tmp_path / "again.yaml").read_text().splitlines()[0] == source.read_text().splitlines()[0]


@pytest.mark.parametrize("mass", [-0.1, 0.0])
def test_a_payload_without_a_mass_has_the_least_one(mass):
    found = parameters(np.array([mass, 0.0, 0.0, 0.0]), 1000.0)
    assert found[0] == LEAST_KG
    assert np.isfinite(found).all()

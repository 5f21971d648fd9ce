"""`./reproduce observe`: what it prints and writes, and a humanoid's log with its own mistakes."""

import os
import re
from functools import partial
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from library_settings import walk_settings

from mobnet.core.columns import recording_columns
from mobnet.core.recording_file import read_sensed
from mobnet.core.store import read_array
from mobnet.kernel.low_pass import low_pass
from mobnet.robot.description import describe
from mobnet.robotlog.observe import main, observe_log
from mobnet.simulation.simulator import Simulator

RATE_HZ, WALKED_S = 1000, 12
G = 9.80665
ENDS = tuple(f"{part}_{axis}" for part in ("force", "moment") for axis in "xyz")


@pytest.fixture
def say(saying):
    return partial(saying, main)


def test_a_csv_becomes_recording_estimate_and_plot(clean, arm, stored, say, tmp_path):
    out = tmp_path / "made"
    status, lines = say(stored(clean), "--robot", "tests/data/arm.yaml", "--out", out)
    assert status == 0
    assert lines[0] == "12000 samples at 1000 Hz, 12 s in 1 segment, as they are in the log"
    assert "hints: none" in lines
    assert (out / "residual.png").stat().st_size > 10_000
    sensed = read_sensed(out / "recording", arm.layout).sensed
    np.testing.assert_allclose(sensed.q[:, 1], clean["q.J2"], atol=1e-6)
    estimate, note = read_array(out / "estimate")
    assert [column["name"] for column in note["columns"]] == ["tau_ext.J1", "tau_ext.J2"]
    # The residual is the friction that the log's torques contain and the model does not.
    friction = 0.4 * np.tanh(clean["v.J1"] / 0.05) + 0.3 * clean["v.J1"]
    late = low_pass(friction.to_numpy()[:, None], 100.0, RATE_HZ)[:, 0]
    assert np.corrcoef(estimate[100:, 0], -late[100:])[0, 1] > 0.85  # the rest is the noise of the velocity


def test_numbers_of_joints_with_long_names_stand_below_each_other(clean, stored, say, tmp_path):
    long = "right_shoulder_pitch_joint"
    text = Path("tests/data/arm.yaml").read_text()
    (tmp_path / "arm.yaml").write_text(re.sub(r"\bJ1\b", long, text))
    log = stored(clean[:3000].rename(columns=lambda name: name.replace("J1", long)))
    status, lines = say(log, "--robot", tmp_path / "arm.yaml", "--out", tmp_path / "made")
    rows = [line for line in lines if line.startswith((f"  {long} ", "  J2 "))]
    assert (status, len(rows)) == (0, 2)
    assert len({line.index(" of ") for line in rows}) == 1


def test_a_map_file_is_read_and_its_faults_have_places(clean, stored, say, tmp_path):
    path = stored(clean.rename(columns=lambda name: name.replace(".", "_")))
    (tmp_path / "map.yaml").write_text(
        "torque: mean\n"
        "q: {columns: [q_J1, q_J2]}\nv: {columns: [v_J1, v_J2]}\n"
        "tau_motor: {columns: [tau_motor_J1, tau_motor_J2], unit: N m}\n"
    )
    words = path, "--robot", "tests/data/arm.yaml", "--out", tmp_path / "made"
    assert say(*words, "--map", tmp_path / "map.yaml")[0] == 0
    (tmp_path / "map.yaml").write_text("q: {columns: [q_J1], units: rad}\n")
    status, lines = say(*words, "--map", tmp_path / "map.yaml")
    assert status == 1
    assert any("map.yaml" in line and "units" in line and "unit" in line for line in "\n".join(lines).splitlines())


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("--gain", "0"), "--gain: 0.0 is not accepted; accepted: a number from 0.1 to 5000"),
        (("none.csv",), "file is missing"),
    ],
)
def test_a_bad_word_is_one_line(words, message, clean, stored, say):
    log = words if words[0] == "none.csv" else (stored(clean[:100]), *words)
    status, lines = say(*log, "--robot", "tests/data/arm.yaml")
    assert (status, len(lines)) == (1, 1)
    assert message in lines[0]


def test_a_folder_that_cannot_be_written_to_is_one_line_before_the_log_is_read(clean, stored, say, tmp_path):
    (tmp_path / "file").write_text("")
    status, lines = say(stored(clean[:100]), "--robot", "tests/data/arm.yaml", "--out", tmp_path / "file" / "made")
    assert (status, len(lines)) == (1, 1)
    assert f"{tmp_path}/file" in lines[0]


def test_what_a_killed_observe_left_is_swept_and_a_refused_log_leaves_nothing(clean, stored, say, tmp_path):
    (tmp_path / "made").mkdir()
    (tmp_path / "made" / ".partial.abc.recording.parquet").write_text("half")
    log, words = stored(clean[:2000]), ("--robot", "tests/data/arm.yaml", "--out")
    assert say(log, *words, tmp_path / "made")[0] == 0
    assert not list((tmp_path / "made").glob(".partial*"))
    log = stored(clean[:20].assign(**{"q.J1": 1e308}))
    assert say(log, *words, tmp_path / "none")[0] == 1
    assert not (tmp_path / "none").exists()


@pytest.mark.parametrize("largest", [1e14, 1e29])
def test_a_huge_speed_has_a_folder_or_a_line_that_names_it(largest, clean, stored, say, tmp_path):
    log = stored(clean[:500].assign(**{"v.J2": np.r_[clean["v.J2"][:499], largest]}))
    status, lines = say(log, "--robot", "tests/data/arm.yaml", "--out", tmp_path / "made")
    if largest < 1e15:
        assert (status, (tmp_path / "made" / "estimate.parquet").exists()) == (0, True)
    else:
        (line,) = lines
        assert re.search(r"column 'v.J2', sample 499: 1e\+29 is not accepted; accepted: numbers up to 1e\+15", line)


@pytest.mark.parametrize("make", [os.mkfifo, lambda path: path.symlink_to("/dev/zero")], ids=["pipe", "device"])
def test_a_pipe_and_a_device_are_no_log(make, say, tmp_path):
    make(tmp_path / "log.csv")
    status, lines = say(tmp_path / "log.csv", "--robot", "tests/data/arm.yaml")
    assert (status, lines) == (1, [f"{tmp_path}/log.csv: a pipe or a device is not accepted; accepted: a file"])


@pytest.mark.parametrize("name", ["log.csv", "log.bag", "log.npz", "log.mcap", "log.h5"])
def test_a_file_of_nothing_but_room_is_one_line(name, say, tmp_path):
    with (tmp_path / name).open("wb") as file:
        file.truncate(20 * 2**30)
    status, lines = say(tmp_path / name, "--robot", "tests/data/arm.yaml")
    assert (status, len(lines)) == (1, 1)


@pytest.fixture(scope="module")
def walk(settings):
    """A walk of a surrogate robot, with its gears and noisy sensors, as a table with the columns of a recording."""
    simulator = Simulator(walk_settings(settings, "walk_test", "robot_1"), 240)
    simulator.start()
    columns = [name for group in recording_columns(describe(settings.robot).layout).values() for name, *_ in group]
    rows = np.zeros((WALKED_S * RATE_HZ, len(columns)), dtype=np.float32)
    done = simulator.run(rows)
    assert done == len(rows)
    return pd.DataFrame({"time": np.arange(done) / RATE_HZ, **dict(zip(columns, rows.T, strict=True))})


def without_gravity(table):
    """Return what a sensor that takes gravity away reads, in the axes of a base whose quaternion turns it upright."""
    w, x, y, z = (table[f"q.quat_{axis}"] for axis in "wxyz")
    up = {"x": 2 * (x * z - w * y), "y": 2 * (y * z + w * x), "z": 1 - 2 * (x * x + y * y)}
    return table.assign(**{f"acc.{axis}": table[f"acc.{axis}"] - G * part for axis, part in up.items()})


def turned(table):
    """Return a log whose quaternions are written x y z w."""
    names = [f"q.quat_{axis}" for axis in "wxyz"]
    return table.assign(**{name: table[names[(k + 1) % 4]] for k, name in enumerate(names)})


def with_feet_exchanged(table):
    pairs = [(f"wrench_left_foot.{end}", f"wrench_right_foot.{end}") for end in ENDS]
    return table.assign(**{a: table[b] for pair in pairs for a, b in (pair, pair[::-1])})


def in_another_order(table):
    """Return a log in which each torque of a leg stands in the column of the joint before."""
    names = [f"tau_motor.LL{k}" for k in range(1, 7)]
    return table.assign(**dict(zip(names, (table[name] for name in names[1:] + names[:1]), strict=True)))


def late(table, start, rows):
    return table.assign(**{name: table[name].shift(rows).bfill() for name in table if re.match(start, name)})


def held(table, start, rows):
    kept = (np.arange(len(table)) // rows) * rows
    return table.assign(**{name: table[name].to_numpy()[kept] for name in table if name.startswith(start)})


def times(table, start, factor):
    return table.assign(**{name: factor * table[name] for name in table if name.startswith(start)})


WALKING = {
    "nothing": (lambda t: t, None),
    "no sensor at the feet": (lambda t: t[[name for name in t if not name.startswith("wrench_")]], None),
    "acc in g": (lambda t: times(t, "acc.", 1 / G), "acc: its mean has a size of .* in units of g"),
    "acc without gravity": (without_gravity, "acc: its mean has a size of .* gravity is removed"),
    "quaternion x y z w": (turned, "quaternion or acc: .* x y z w"),
    "omega in deg/s": (lambda t: times(t, "v.omega", 180 / np.pi), r"omega: its integral is 5[67](?:\.\d)? times"),
    "feet that read what the robot does": (
        lambda t: times(t, "wrench_", -1.0),
        "feet: .* what the robot does to the gr",
    ),
    "feet exchanged": (with_feet_exchanged, "LL1, LL2.*: the sensors of the left and the right foot are exchanged"),
    "torques of a leg in another order": (in_another_order, "another order: LL1 has that of LL2, LL2 has that of LL3"),
    "omega held": (lambda t: held(t, "v.omega", 5), "omega: 80% of the samples repeat the one before"),
    "late speeds": (
        lambda t: late(t, r"v\.[LRWN]", 8),
        r"v of LL1, LL2, .* more: (?:7\.[5-9]\d?|8(?:\.[0-4]\d?)?) ms late against q",
    ),
    "a foot's sensor that reads half": (lambda t: times(t, "wrench_left_foot", 0.5), "feet: their sensors carry 0.7"),
    "hip of the wrong sign": (lambda t: times(t, "tau_motor.LL3", -1.0), "LL3: tau_motor is of the wrong sign"),
    "waist before the gear": (lambda t: times(t, "tau_motor.W2", 0.01), r"W2: tau_motor is 1/\d+ .* before the gear"),
}


@pytest.mark.sim
@pytest.mark.slow
@pytest.mark.parametrize("name", WALKING)
def test_a_humanoids_mistakes_are_named_and_its_clean_log_has_no_hint(name, walk, robot, settings, tmp_path):
    spoil, pattern = WALKING[name]
    spoil(walk).to_parquet(tmp_path / "walk.parquet")
    found = observe_log(tmp_path / "walk.parquet", robot, None, "mean", 100.0, 9.81, settings.robotlog).hints
    if pattern is None:
        assert found == ()
    else:
        assert len(found) == 1
        assert pd.Series(found).str.contains(pattern, regex=True).all(), found

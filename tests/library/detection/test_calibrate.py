"""The calibrator prints thresholds, rate and forces of a walk, and one clear line where it cannot."""

import json
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from made_swings import AIR, GROUND, RATE_HZ, unseen

from mobnet.core.columns import torque_columns
from mobnet.core.recording import Recording
from mobnet.core.recording_file import write_recording
from mobnet.core.store import write_array
from mobnet.detection.calibrate import main

SWINGS = 240


@pytest.fixture
def write(walk, layout, tmp_path):
    """A function that writes a walk with an estimate, and returns words that name them."""

    def files(swings=SWINGS, rate_hz=RATE_HZ):
        sensed = walk(swings)
        count, truth = len(sensed), unseen(layout, len(sensed))
        joints, rng = layout.limb("LL"), np.random.default_rng(0)
        sizes = np.repeat(rng.lognormal(0.0, 0.3, swings + 1), AIR + GROUND)[:count]
        torque = sizes[:, None] * np.array([1.0, 4.0, 3.0, 2.0, 1.5, 0.5]) * (1.0 + 0.01 * rng.normal(size=(count, 6)))
        folder = tmp_path / f"{rate_hz:g}"
        write_recording(folder / "walk", Recording(sensed, ((0, count),), rate_hz, {}, truth), layout)
        columns = torque_columns(layout, ["tau_ext"], joints)
        write_array(folder / "estimate", torque, columns, {"rate_hz": rate_hz})
        return ["--recording", str(folder / "walk.parquet"), "--estimate", str(folder / "estimate")]

    return files


def test_thresholds_rate_and_forces_are_printed(write, caplog):
    caplog.set_level("INFO", "mobnet.detection")
    assert main([*write(), "--rate", "20"]) == 0
    text = "\n".join(caplog.messages)
    assert f"{SWINGS} swings" in text
    found = {line.split()[0]: float(line.split()[1]) for line in text.splitlines() if line.startswith("LL")}
    assert list(found) == [f"LL{k}" for k in range(1, 7)]
    assert found["LL2"] == pytest.approx(4.0 * found["LL1"], rel=0.05)
    assert "false alarms to expect: 20 in an hour of walking, 95% interval" in text
    forces = {line.split()[0]: float(line.split()[1]) for line in text.splitlines() if line.startswith("left_")}
    assert set(forces) == {f"left_{link}_{side}" for link in ("foot", "ankle", "knee") for side in ("front", "side")}
    assert forces["left_knee_front"] > forces["left_foot_front"]


@pytest.mark.parametrize(("swings", "text"), [
    (0, "the leg is watched in none of the swings that calibrate"),
    (40, "40 swings that calibrate; 200 or more are needed, some minutes of walking"),
])  # fmt: skip
def test_a_walk_that_calibrates_nothing_is_one_line_and_no_threshold(write, caplog, swings, text):
    assert main(write(swings)) == 1
    (line,) = caplog.messages
    assert text in line
    assert "\n" not in line


def test_a_lost_sample_of_an_estimate_is_told(write, caplog):
    """As the log of another program may have one."""
    words = write()
    path, note = (Path(words[-1]).with_suffix(ending) for ending in (".parquet", ".json"))
    table = pq.read_table(path)
    values = [np.array(column) for column in table.columns]
    values[4][1234] = np.nan
    pq.write_table(pa.table([pa.array(column) for column in values], schema=table.schema), path)
    said = json.loads(note.read_text())
    note.write_text(json.dumps({key: value for key, value in said.items() if key != "footer"}))
    assert main(words) == 1
    assert "column 'tau_ext.LL5', row 1234: nan is not accepted; accepted: " in caplog.text


@pytest.mark.parametrize(("words", "text"), [
    (["--leg", "W"], "column 'tau_ext.W1' is missing; accepted: an estimate of W1, W2, W3"),
    (["--limb", "X"], "limb: 'X' is not accepted; accepted: "),
    (["--out", "x.yaml"], "--out x.yaml: it needs folders that"),
    (["folder"], "both are given; either folders that"),
    (["--rate", "0"], "--rate: 0.0 is not accepted; accepted: a number from 1e-06"),
    (["--rate", "inf"], "--rate: inf is not accepted; accepted: a number from 1e-06"),
    (["--rate", "nan"], "--rate: nan is not accepted; accepted: a number from 1e-06"),
    (["--estimate", "more"], "--estimate: 2 is not accepted; accepted: 1, one for each --recording"),
])  # fmt: skip
def test_words_that_fit_nothing_are_told(write, caplog, words, text):
    assert main([*write(3), *words]) == 1
    assert text in caplog.text


def test_recordings_have_one_rate(write, caplog):
    assert main([*write(3), *write(3, rate_hz=500.0)]) == 1
    assert "walk: rate_hz is 500.0; all need that of " in caplog.text

"""Recordings, residuals and estimates that break the contract are refused by jobs that read them, and by a check."""

import json
import re

import numpy as np
import pyarrow as pa
import pytest
from tests.paper.outside.conftest import (
    AGAINST,
    RATE_HZ,
    changed_note,
    changed_table,
    moved,
    put,
    refusal_of,
    refusals,
    scaled,
    set_at,
    without_footer,
)  # fmt: skip

from experiments.check import check
from experiments.jobs.estimates import estimate
from experiments.plan.parts import MethodRun
from experiments.settings.catalogue import Catalogue
from mobnet.core.columns import recording_columns, recording_width
from mobnet.core.errors import DataError
from mobnet.core.recording import Truth
from mobnet.core.recording_file import read_sensed
from mobnet.core.store import read_array, write_array
from mobnet.learning.dataset import load_limb_data

ROWS, WIDTH = 1200, recording_width(AGAINST.layout)


def column(index, **changes):
    """Return a change of a note that sets keys of a column."""
    return lambda note: note["columns"][index].update(changes)


NOTES = {
    **refusals(
        {
            "rows": (0, -1, "1200", 1200.5, True),
            "rate_hz": (0.0, -1000.0, np.nan, np.inf, "1 kHz", None, 500.0, 999.0, 1e300),
            "segments": ([], "all"),
            "segments.0": ([600, 0], [5, 5], [0, 1201], [0, 1, 2], [0], 0),
            "segments.0.0": (-1, 0.0),
            "segments.1": ([0, 600], [500, 1200]),
            "columns": ("q", []),
            "columns.0": ("q.LL1",),
            "columns.7.name": (7, ""),
            "seed": ("3", -1),
            "level": (1,),
            "scenario": ("",),
            "falls": (-1,),
            "clearance_min_m": (60.0,),
            "provenance": ("mine",),
        },
        "rows segments rate_hz columns columns.7.unit columns.7.name",
    ),
    "rows of another file": (
        set_at("rows", ROWS + 1),
        rf"shape \(1200, {WIDTH}\) is not accepted; accepted: \(1201, {WIDTH}\), as recording.json says",
    ),
    "rate of another plant": (set_at("rate_hz", 900.0), "rate_hz: 900.0 is not accepted; accepted: 1000"),
    "column twice": (lambda n: n["columns"].append(n["columns"][0]), "columns: 'q.base_x' occurs 2 times"),
    "degrees": (column(7, unit="deg"), "columns: 'q.LL1': unit 'deg', frame 'joint' is not .*: unit 'rad'"),
    "degrees a second": (column(49, unit="deg/s"), "columns: 'v.LL4': unit 'deg/s', frame 'joint' is not accepted"),
    "millimetres": (column(0, unit="mm"), "columns: 'q.base_x': unit 'mm'"),
    "base frame": (column(40, frame="base"), "columns: 'v.base_x': unit 'm/s', frame 'base' is not accepted"),
    "omega in world": (column(43, frame="world"), "columns: 'v.omega_x': unit 'rad/s', frame 'world' is not accepted"),
    "gravity in g": (column(79, unit="g"), "columns: 'acc.x': unit 'g', frame 'base' is not accepted; accepted: .*m/s"),
    "force as torque": (lambda n: n["columns"][157].update(unit="N m", frame="joint"), "'tau_ext.V1': unit 'N m'"),
    "column of another name": (column(7, name="q.LL9"), "column.* 'q.LL1'"),
    "terrains too few": (set_at("terrains", ["flat"]), r"terrains: \['flat'\] is not .*: one for each of 2"),
    "a list": (lambda note: [note], "accepted: a JSON object"),
    "a number": (lambda _: 5, "recording.json: 5 is not accepted; accepted: a JSON object"),
    "empty": (lambda _: {}, "rows: key is missing"),
}


@pytest.mark.parametrize("name", NOTES)
def test_a_note_that_breaks_the_contract_is_refused(name, copied, refused):
    change, says = NOTES[name]
    changed_note(copied / "recording", change)
    lines = refused(copied / "recording")
    assert len(re.findall(says, lines)) >= 2, lines


Q, V = ([f"{signal}.LL{i}" for i in range(1, 7)] for signal in "qv")
QUAT = [f"q.quat_{a}" for a in "wxyz"]
TABLES = {
    "NaN": (put("q.LL3", 5, np.nan), "column 'q.LL3', row 5: nan is not accepted; accepted: finite numbers"),
    "infinite": (put("tau_motor.LL3", 1199, np.inf), "column 'tau_motor.LL3', row 1199: inf is not accepted"),
    "quaternion of norm 2": (scaled(QUAT, 2.0), "column 'q.quat_w', row 0: 2|q.quat_w'.*norm"),
    "quaternion of norm 0.5": (scaled(QUAT, 0.5), "row 0: norm: 0.5 is not .*accepted: 1"),
    "one bad quaternion": (put("q.quat_x", 77, 0.9), "'q.quat_w' to 'q.quat_z', row 77: norm"),
    "positions in degrees": (scaled(Q, 57.3), "v of LL1, LL2, LL3 and 3 more: an integral of 0.017"),
    "velocities in degrees": (scaled(V, 57.3), "v of LL1, .*: an integral of 57.3 x the change"),
    "both in degrees": (scaled([f"{s}.LL4" for s in "qv"], 5730.0), "column 'q.LL4', row 0: .* is not .*3.24 rad"),
    "one velocity of wrong sign": (scaled(["v.LL4"], -1.0), "v of LL4: an integral of -1 x the change of q"),
    "omega in degrees": (scaled([f"v.omega_{a}" for a in "xyz"], 57.3), "v.omega of .*: an integral of 57.*q.quat"),
    "omega of wrong sign": (scaled([f"v.omega_{a}" for a in "xyz"], -1.0), "v.omega of x, y, z: an integral of -1"),
    "quaternion x y z w": (moved(QUAT), "v.omega of .* the change of q.quat"),
    "two joints swapped": (moved(["q.LL3", "q.LL4"]), "v of LL3, LL4: an integral"),
    "no gravity": (scaled(["acc.z"], 0.0), "acc, turned into world axes: mean: .* is not .*: 1.5 to 30"),
    "gravity downwards": (scaled(["acc.z"], -1.0), "acc, turned into world axes: mean"),
    "gravity in g": (scaled([f"acc.{a}" for a in "xyz"], 1 / 9.81), "acc, turned into world axes: mean"),
    "beyond a joint's range": (put("q.LL4", 9, 3.5), r"column 'q.LL4', row 9: 3.5 is not .*: -3.24 to 3.24"),
    "faster than the motor": (put("v.LL4", 9, 90.0), "column 'v.LL4', row 9: 90.0 is not .*: -60 to 60"),
    "torque in mN m": (scaled(["tau_motor.LL3"], 1000.0), "column 'tau_motor.LL3', row .* -789 to 789 N m"),
    "swing of 2": (put("swing.left_foot", 3, 2.0), "column 'swing.left_foot', row 3: 2.0 is not .*: 0 or 1"),
    "turn in degrees": (put("command.turn", 3, 20.0), "column 'command.turn', row 3: 20.0 is not accepted"),
    "step in millimetres": (put("command.step_x", 3, 200.0), "column 'command.step_x', row 3: 200.0 is not accepted"),
    "base too fast": (put("v.base_x", 3, 300.0), "column 'v.base_x', row 3: 300.0 is not .*: -20 to 20"),
    "a column is gone": (
        lambda t: t.drop_columns(["q.LL3"]),
        rf"shape \(1200, {WIDTH - 1}\) \(columns of one alone: .*\) is not accepted; accepted: \(1200, {WIDTH}\)",
    ),
    "a column more": (lambda t: t.append_column("x", [np.zeros(ROWS)]), r"\(columns of one alone: x\) is not"),
    "rows are gone": (lambda t: t.slice(0, 900), rf"shape \(900, {WIDTH}\) is not accepted; accepted: \(1200,"),
    "no rows": (lambda t: t.slice(0, 0), rf"shape \(0, {WIDTH}\) is not"),
    "another name": (
        lambda t: t.rename_columns(["p", *t.column_names[1:]]),
        "column: 'p' is not accepted; accepted: q.base_x, those that recording.json has",
    ),
    "integers": (lambda t: t.set_column(0, "q.base_x", [np.zeros(ROWS, int)]), "column 'q.base_x': type: 'int64'"),
    "text": (lambda t: t.set_column(0, "q.base_x", [["0"] * ROWS]), "column 'q.base_x': type: 'string' is not"),
    "lists": (lambda t: t.set_column(0, "q.base_x", [[[0.0]] * ROWS]), "column 'q.base_x': type: 'list<.*' is not"),
    "truth values": (lambda t: t.set_column(0, "q.base_x", [[True] * ROWS]), "column 'q.base_x': type: 'bool' is not"),
    "codes": (lambda t: t.set_column(0, "q.base_x", pa.array(["a"] * ROWS).dictionary_encode()), "type: 'dictionary"),
    "null": (lambda t: t.set_column(0, "q.base_x", [[None] + [0.0] * (ROWS - 1)]), "'q.base_x', row 0: nan is not"),
    "unit of the table": (
        lambda t: t.cast(t.schema.set(7, t.schema.field(7).with_metadata({"unit": "deg"}))),
        "column 'q.LL1': unit: 'deg' is not accepted; accepted: 'rad', as its note says",
    ),
    "frame of the table": (
        lambda t: t.cast(t.schema.set(0, t.schema.field(0).with_metadata({"frame": "base"}))),
        "column 'q.base_x': frame: 'base' is not accepted; accepted: 'world'",
    ),
}


@pytest.mark.parametrize("name", TABLES)
def test_a_table_that_breaks_the_contract_is_refused(name, copied, refused):
    change, says = TABLES[name]
    changed_table(copied / "recording", change)
    lines = refused(copied / "recording")
    assert len(re.findall(says, lines)) >= 2, lines


UNREAD = {  # by rule `observe`, which takes of the truth the external torque alone
    "contact of a half": (put("contact.left_foot", 3, 0.5), "'contact.left_foot', row 3: 0.5 is not accepted"),
    "pushed below zero": (put("pushed", 3, -1.0), "column 'pushed', row 3: -1.0 is not accepted; accepted: 0 or 1"),
    "no force": (put("wrench_left_foot.force_z", 3, np.nan), "column 'wrench_left_foot.force_z', row 3: nan is not"),
}


@pytest.mark.parametrize("name", UNREAD)
def test_what_no_observer_reads_is_refused_by_a_check(name, copied):
    change, says = UNREAD[name]
    changed_table(copied / "recording", change)
    assert re.search(says, refusal_of(copied / "recording.json"))
    changed_note(copied / "recording", without_footer)
    assert len(read_sensed(copied / "recording", AGAINST.layout).sensed) == ROWS


FILES = {
    "truncated": (".parquet", lambda data: data[: len(data) // 2], "truncated or damaged"),
    "without its end": (".parquet", lambda data: data[:-1], "truncated or damaged"),
    "empty": (".parquet", lambda _: b"", "truncated or damaged"),
    "not parquet": (".parquet", lambda _: b"PAR1 and nothing else PAR1", "truncated or damaged"),
    "note empty": (".json", lambda _: b"", "not JSON"),
    "note cut off": (".json", lambda data: data[:100], "not JSON"),
    "note not UTF-8": (".json", lambda data: b"\xff" + data, "not text in UTF-8, byte 0"),
    "note nested without end": (".json", lambda _: b"[" * 100_000, "not JSON"),
    "note with a key twice": (".json", lambda data: b'{"rows": 1,' + data[1:], "key 'rows' occurs twice"),
    "note with an endless number": (".json", lambda data: b'{"x": 1e999,' + data[1:], "x: inf is not accepted"),
    "note with a number of 5000 digits": (".json", lambda data: b'{"x": 1' + b"0" * 5000 + b"," + data[1:], "not JSON"),
}


@pytest.mark.parametrize("name", FILES)
def test_a_damaged_file_is_refused(name, copied, refused):
    ending, damage, says = FILES[name]
    path = (copied / "recording").with_suffix(ending)
    path.write_bytes(damage(path.read_bytes()))
    assert refused(copied / "recording").count(says) == 2


@pytest.mark.parametrize("ending", [".parquet", ".json"])
@pytest.mark.parametrize("how", ["missing", "folder", "link to nowhere"])
def test_a_file_that_is_none_is_refused(ending, how, copied, refused):
    path = (copied / "recording").with_suffix(ending)
    path.unlink()
    if how == "folder":
        path.mkdir()
    elif how == "link to nowhere":
        path.symlink_to("nowhere")
    assert refused(copied / "recording").count(path.name) >= 2


def test_every_fault_of_a_file_is_told_and_there_are_not_too_many(copied, refused):
    changed_note(copied / "recording", lambda note: note.update(rows=-1, rate_hz="x", segments=[[0]]))
    lines = refused(copied / "recording").splitlines()
    assert [line.partition(": ")[2].partition(": ")[0] for line in lines[:3]] == ["rows", "segments.0", "rate_hz"]
    changed_note(copied / "residual", lambda note: [column.update(unit="?") for column in note["columns"]] and None)
    lines = refusal_of(copied / "residual.json").splitlines()
    assert (len(lines), lines[-1].rpartition(": ")[2]) == (21, "136 further faults")


def test_a_robots_log_may_lack_truth_and_have_more_columns_in_any_order(copied, layout):
    array, note = read_array(copied / "recording")
    columns = [tuple(column.values()) for column in note["columns"]]
    unseen = {name for field in Truth.__dataclass_fields__ for name, *_ in recording_columns(layout)[field]}
    kept = [k for k, (name, *_) in enumerate(columns) if name not in unseen]
    kept.reverse()
    log = np.concatenate([array[:, kept], np.full((ROWS, 1), 37.0)], axis=1)
    write_array(copied / "log", log, [*(columns[k] for k in kept), ("temperature", "deg C", "motor")], {"rate_hz": 1e3})
    assert len(read_sensed(copied / "log", layout).sensed) == ROWS
    assert check(copied / "log.json", AGAINST) == "recording, 1200 rows at 1000 Hz, 1.2 s in 1 segment, 158 columns"


def test_a_name_may_have_dots(copied, layout):
    for ending in (".json", ".parquet"):
        (copied / f"recording{ending}").rename(copied / f"log.v1.5{ending}")
    assert len(read_sensed(copied / "log.v1.5", layout).sensed) == ROWS
    assert check(copied / "log.v1.5.parquet", AGAINST).startswith("recording, 1200 rows")


@pytest.mark.parametrize("kind", ["recording", "residual", "estimate"])
def test_a_sound_array_is_accepted(kind, copied):
    assert check(copied / f"{kind}.parquet", AGAINST).startswith(f"{kind}, 1200 rows at 1000 Hz, 1.2 s in 2 segments")


@pytest.mark.parametrize(("kind", "change", "says"), [
    ("residual", put("r.LL3", 4, np.nan), "column 'r.LL3', row 4: nan"),
    ("residual", scaled(["tau_ext_lp.V3"], 1e9), "column 'tau_ext_lp.V3', row 0: .* -1e\\+06 to 1e\\+06 N"),
    ("estimate", put("std.LL3", 4, 0.0), "column 'std.LL3', row 4: 0.0 is not accepted"),
    ("estimate", put("std.LL3", 4, -1.0), "column 'std.LL3', row 4: -1.0 is not accepted"),
    ("residual", lambda t: t.drop_columns(["r.LL3"]), r"shape \(1200, 77\)"),
])  # fmt: skip
def test_a_residual_or_an_estimate_that_breaks_the_contract_is_refused(kind, change, says, copied):
    changed_table(copied / kind, change)
    with pytest.raises(DataError, match=says):
        read_array(copied / kind)
    with pytest.raises(DataError, match=says):
        check(copied / f"{kind}.json", AGAINST)


@pytest.mark.parametrize(("change", "says"), [
    (set_at("segments", [[0, ROWS]]), r"residual.json: segments: \[\[0, 1200\]\] is not .*: \[\[0, 600"),
    (set_at("seed", 8), "residual.json: seed: 8 is not accepted; accepted: 3, as in .*recording.json, its recording"),
    (set_at("level", "ideal"), "residual.json: level: 'ideal' is not accepted; accepted: 'all_uncertainty'"),
    (set_at("rate_hz", 500.0), "residual.json: rate_hz: 500.0 is not accepted; accepted: 1000.0"),
])  # fmt: skip
def test_a_residual_of_another_recording_trains_no_network(change, says, copied, settings):
    changed_note(copied / "residual", change)
    limb = Catalogue(settings).network("MOB-Net", "LL")
    with pytest.raises(DataError, match=says):
        load_limb_data(settings.layout, limb, "external", [copied / "recording"], [copied / "residual"], RATE_HZ)


def test_networks_and_observers_take_recordings_of_the_configured_rate_alone(copied, settings):
    changed_note(copied / "recording", set_at("rate_hz", 900.0))
    level, gravity = settings.levels["all_uncertainty"], settings.plant.gravity_m_s2
    runs = [MethodRun("MOB", {"MOB": Catalogue(settings).method("MOB")}, {}, None, 0)]
    files = [copied / "recording"], [copied / "residual"]
    with pytest.raises(DataError, match=r"rate_hz: 900.0 is not accepted; accepted: 1000, `rates.data_hz`"):
        estimate(settings.robot, level, gravity, settings.observer, runs, *files, copied / "out", RATE_HZ)
    limb = Catalogue(settings).network("MOB-Net", "LL")
    with pytest.raises(DataError, match=r"rate_hz: 900\.0 is not accepted"):
        load_limb_data(settings.layout, limb, "external", *files, RATE_HZ)


def test_the_writer_keeps_the_contract_too(tmp_path):
    columns = [("a", "m", "world")]
    for rows, meta, segments, says in (
        (0, {"rate_hz": 1.0}, None, "rows: 0 is not accepted"),
        (5, {}, None, "rate_hz: key is missing"),
        (5, {"rate_hz": 1.0}, [(0, 3), (2, 5)], r"segments.1: \[2, 5\] is not accepted"),
    ):
        with pytest.raises(DataError, match=says):
            write_array(tmp_path / "s", np.zeros((rows, 1)), columns, meta, segments)
    assert not list(tmp_path.iterdir())


def test_json_that_names_no_kind_is_refused(tmp_path):
    (tmp_path / "x.json").write_text(json.dumps({"a": 1}))
    assert "accepted: a recording, residual" in refusal_of(tmp_path / "x.json")

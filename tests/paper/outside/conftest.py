"""Files from outside, each sound, and a function that says how the readers of jobs take them."""

import json
import re
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pyarrow.parquet as pq
import pytest
from made_notes import training_note

from experiments.check import Against, check
from experiments.jobs.observing import observe
from experiments.records.scores import Score
from mobnet.core.columns import torque_columns
from mobnet.core.epochs import Epoch
from mobnet.core.errors import MobnetError
from mobnet.core.recording_file import write_recording
from mobnet.core.store import write_array

RATE_HZ = 1000.0
AGAINST = Against()  # reads the configuration once
Change = Callable[[Any], Any]
META = {"scenario": "random_walk", "level": "all_uncertainty", "seed": 3}


@pytest.fixture(scope="session")
def sound(tmp_path_factory, made_up, layout):
    """A folder with `recording`, `residual` and `estimate` of the same 1.2 s in two segments."""
    folder = tmp_path_factory.mktemp("sound")
    whole = replace(made_up(seed=4, seconds=1.2, segments=2), meta=META)
    write_recording(folder / "recording", whole, layout)
    torque = whole.truth.tau_ext
    for name, signals in (("residual", ("r", "tau_ext_lp")), ("estimate", ("tau_ext", "std"))):
        array = np.concatenate([torque, np.abs(torque) + 1.0], axis=1)
        meta = {"rate_hz": RATE_HZ, **META}
        write_array(folder / name, array, torque_columns(layout, signals, layout.names), meta, whole.segments)
    return folder


@pytest.fixture
def copied(sound, tmp_path):
    for file in sound.iterdir():
        (tmp_path / file.name).write_bytes(file.read_bytes())
    return tmp_path


@pytest.fixture(scope="session")
def refused(settings):
    """Return a function of a recording's stem: the lines with which rule `observe` and a check refuse it."""

    def lines(stem):
        out, level = stem.with_name("out"), settings.levels["all_uncertainty"]
        gravity = settings.plant.gravity_m_s2
        with pytest.raises(MobnetError) as found:
            observe(settings.robot, level, gravity, settings.observer, stem, out, RATE_HZ)
        assert not list(out.parent.glob("out*"))
        return told(str(found.value)) + "\n" + refusal_of(stem.with_suffix(".json"))

    return lines


def refusal_of(path):
    with pytest.raises(MobnetError) as found:
        check(path, AGAINST)
    return told(str(found.value))


def told(text):
    """Return lines of faults, each of which begins with the place of a file."""
    assert all(line.startswith("/") and ": " in line and len(line) < 1000 for line in text.splitlines()), text
    return text


def changed_note(stem, change):
    """Change the note of an array in place; what the function returns replaces it."""
    path = stem.with_suffix(".json")
    note = json.loads(path.read_text())
    changed = change(note)
    path.write_text(json.dumps(note if changed is None else changed))


def set_at(place, value):
    """Return a change of a note that sets a value at a place, keys joined by dots."""

    def change(note):
        parent, last = parent_of(note, place)
        parent[last] = value

    return change


def lost(place):
    """Return a change of a note that deletes what is at a place."""

    def change(note):
        parent, last = parent_of(note, place)
        del parent[last]

    return change


def parent_of(note, place):
    """Return what holds the value at a place of a note, and its key or number there."""
    *inner, last = (int(key) if key.isdigit() else key for key in place.split("."))
    for key in inner:
        note = note[key]
    return note, last


def refusals(wrong, needed):
    """Return changes of a note with what is told of them: values that a place does not accept, and places lost."""
    values = [(place, value) for place, values in wrong.items() for value in values]
    return {
        **{f"{k} as {v!r}": (set_at(k, v), f"{k}: {re.escape(repr(v))} is not accepted; ") for k, v in values},
        **{f"{place} is gone": (lost(place), f"{place}: key is missing; accepted: ") for place in needed.split()},
    }


def without_footer(note):
    """Take the hash of the array out of its note, as in that of somebody else's array."""
    del note["footer"]


def changed_table(stem, change):
    path = stem.with_suffix(".parquet")
    pq.write_table(change(pq.read_table(path)), path)


def scaled(names, factor):
    """Return a change of a table that multiplies columns."""

    def change(table):
        for name in names:
            place = table.schema.get_field_index(name)
            column = (table.column(name).to_numpy() * factor).astype(np.float32)
            table = table.set_column(place, table.schema.field(name), [column])
        return table

    return change


def moved(names):
    """Return a change of a table that moves numbers from each column to the one before it, the first to the last."""

    def change(table):
        for name, column in zip(names, [table.column(name) for name in (*names[1:], names[0])], strict=True):
            table = table.set_column(table.schema.get_field_index(name), table.schema.field(name), column)
        return table

    return change


def put(name, row, value):
    """Return a change of a table that sets one number."""

    def change(table):
        column = table.column(name).to_numpy().copy()
        column[row] = value
        return table.set_column(table.schema.get_field_index(name), table.schema.field(name), [column])

    return change


@pytest.fixture
def training(tmp_path):
    """The folder of a training of three epochs."""
    folder = tmp_path / "GRU-LL-s1"
    folder.mkdir()
    epochs = [Epoch(k, 1.0 - k, -float(k), 3.0, 0.005, 1.5, 1) for k in (1, 2, 3)]
    rows = [",".join(map(str, vars(epoch).values())) for epoch in epochs]
    (folder / "metrics.csv").write_text("\n".join([",".join(vars(epochs[0])), *rows, ""]))
    (folder / "run.json").write_text(json.dumps(training_note(folder.name, [-1.0, -2.0, -3.0])))
    return folder


@pytest.fixture
def scores(tmp_path):
    """A file of scores."""
    rows = [Score("walk", "ideal", "MOB", 0, test, "LL", joint, "rmse", 1.5, "N m") for test in (1, 2)
            for joint in ("LL1", "avg")]  # fmt: skip
    lines = [",".join(map(str, vars(row).values())) for row in rows]
    (tmp_path / "walk.csv").write_text("\n".join([",".join(vars(rows[0])), *lines, ""]))
    return tmp_path / "walk.csv"

"""Whatever happens to a file from outside, it is refused with lines that name it, or what is read has not changed.

A changed bit of a weight is a number like any other: `./reproduce verify` finds it. All else is found here.
"""

import json

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from tests.paper.outside.conftest import told

from experiments.evaluation.measure.learning.trainings import read_training
from experiments.evaluation.number.rows import read_scores
from mobnet.core.errors import DataError
from mobnet.core.recording_file import read_recording

FEW = settings(max_examples=60, deadline=None, suppress_health_check=list(HealthCheck))
JUNK = st.one_of(
    st.none(), st.booleans(), st.integers(), st.floats(), st.text(max_size=5), st.just([]), st.just({}),
    st.lists(st.integers(), max_size=3), st.lists(st.lists(st.integers(), max_size=3), max_size=3),
)  # fmt: skip


@st.composite
def damages(draw):
    """Draw what happens to the bytes of a file: some flip, some are lost, some come twice."""
    place, size = draw(st.floats(0, 1, exclude_max=True)), draw(st.integers(1, 64))
    how, bit = draw(st.sampled_from(["flip", "lose", "double", "cut"])), draw(st.integers(0, 7))

    def damage(data):
        k = int(place * len(data))
        flipped = data[:k] + bytes([data[k] ^ (1 << bit)]) + data[k + 1 :]
        return {"flip": flipped, "lose": data[:k] + data[k + size :], "double": data[: k + size] + data[k:],
                "cut": data[:k]}[how]  # fmt: skip

    return damage


def outcome(read):
    """Return what is read, or None if it is refused in lines that name a file."""
    try:
        return read()
    except DataError as error:
        told(str(error))
        return None


def same(one, two):
    """Return whether two recordings are equal to the bit."""
    pairs = [(getattr(one, part), getattr(two, part)) for part in ("sensed", "truth")]
    equal = (np.array_equal(getattr(a, name), getattr(b, name)) for a, b in pairs for name in vars(a))
    return one.segments == two.segments and one.rate_hz == two.rate_hz and all(equal)


@FEW
@given(damage=damages())
def test_damaged_samples_are_refused_or_are_the_same(damage, sound, tmp_path, layout):
    whole = (sound / "recording.parquet").read_bytes()
    (tmp_path / "recording.json").write_bytes((sound / "recording.json").read_bytes())
    (tmp_path / "recording.parquet").write_bytes(damage(whole))
    read = outcome(lambda: read_recording(tmp_path / "recording", layout))
    assert read is None or same(read, read_recording(sound / "recording", layout))


def places(value, *above):
    inner = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    return [above, *(place for key, below in inner for place in places(below, *above, key))]


def at(value, place):
    for key in place:
        value = value[key]
    return value


@st.composite
def changes(draw):
    where, junk, gone = draw(st.floats(0, 1, exclude_max=True)), draw(JUNK), draw(st.booleans())

    def change(value):
        found = places(value)
        *above, last = found[1 + int(where * (len(found) - 1))]
        parent = at(value, tuple(above))
        if gone:
            del parent[last]
        else:
            parent[last] = junk
        return value

    return change


@FEW
@given(change=changes())
def test_a_changed_note_of_an_array_is_refused_or_valid(change, sound, tmp_path, layout):
    """What is still valid has the same samples, in segments of them."""
    note = change(json.loads((sound / "recording.json").read_text()))
    (tmp_path / "recording.parquet").write_bytes((sound / "recording.parquet").read_bytes())
    (tmp_path / "recording.json").write_text(json.dumps(note))
    read = outcome(lambda: read_recording(tmp_path / "recording", layout))
    if read is not None:
        np.testing.assert_array_equal(read.sensed.q, read_recording(sound / "recording", layout).sensed.q)
        ends = [0, *(end for segment in read.segments for end in segment), len(read.sensed)]
        assert ends == sorted(ends)
        assert read.rate_hz == pytest.approx(1000.0, rel=0.4)


@FEW
@given(change=changes())
def test_a_changed_run_note_is_refused_or_typed(change, training):
    path = training / "run.json"
    sound = path.read_text()
    path.write_text(json.dumps(change(json.loads(sound))))
    read = outcome(lambda: read_training(training))
    path.write_text(sound)
    if read is not None:
        assert (type(read.method), type(read.seed), type(read.diverged)) == (str, int, bool)
        assert np.isfinite(read.windows_loss)
        assert read.epochs == read_training(training).epochs


@FEW
@given(damage=damages())
@pytest.mark.parametrize("name", ["run.json", "metrics.csv"])
def test_damaged_files_of_a_training_are_refused_or_typed(name, damage, training):
    sound = (training / name).read_bytes()
    (training / name).write_bytes(damage(sound))
    read = outcome(lambda: read_training(training))
    (training / name).write_bytes(sound)
    if read is not None:
        assert [epoch.epoch for epoch in read.epochs] == [1, 2, 3]
        assert np.isfinite([list(vars(epoch).values()) for epoch in read.epochs]).all()


@FEW
@given(damage=damages())
def test_damaged_scores_are_refused_or_numbers(damage, scores):
    sound = scores.read_bytes()
    scores.write_bytes(damage(sound))
    read = outcome(lambda: read_scores(scores))
    scores.write_bytes(sound)
    assert all(np.isfinite(row.value) and row.value >= 0 for row in read or ())

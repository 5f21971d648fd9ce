"""All fields of a recording stay aligned in time, and its files are found and read by the names of their columns."""

from collections.abc import Callable
from dataclasses import fields
from pathlib import Path

import numpy as np
import pandas as pd
import pyarrow.parquet as pq
import pytest

from mobnet.core.columns import recording_columns, recording_width
from mobnet.core.errors import DataError
from mobnet.core.joints import JointLayout
from mobnet.core.recording import Recording, Sensed, Truth
from mobnet.core.recording_file import read_recording, read_sensed, write_recording
from mobnet.core.store import read_array, write_array

META = {"rate_hz": 1000.0}


@pytest.fixture
def recording_stem(tmp_path: Path, made_up: Callable[..., Recording], layout: JointLayout) -> Path:
    write_recording(tmp_path / "s1", made_up(seconds=0.2), layout)
    return tmp_path / "s1"


def test_slicing_takes_the_same_rows_of_every_field_and_spans_are_the_segments(
    made_up: Callable[..., Recording],
) -> None:
    recording, rows = made_up(seconds=0.1, segments=3), slice(20, 50)
    for part in (recording.sensed, recording.truth):
        for name, value in vars(part).items():
            np.testing.assert_array_equal(getattr(part[rows], name), value[rows], err_msg=name)
    assert len(recording.sensed[rows]) == 30
    assert [(span.start, span.stop) for span in recording.spans()] == list(recording.segments)
    assert sum(span.stop - span.start for span in recording.spans()) == len(recording.sensed)


def test_an_estimator_cannot_reach_the_truth() -> None:
    assert not {field.name for field in fields(Sensed)} & {field.name for field in fields(Truth)}


def test_recording_round_trip_is_identity_in_float32(
    tmp_path: Path, made_up: Callable[..., Recording], layout: JointLayout
) -> None:
    recording = made_up(seconds=0.3, segments=3)
    write_recording(tmp_path / "s1", recording, layout)
    read = read_recording(tmp_path / "s1", layout)
    assert read.segments == recording.segments
    for part in ("sensed", "truth"):
        for name, value in vars(getattr(recording, part)).items():
            np.testing.assert_array_equal(getattr(getattr(read, part), name), value.astype(np.float32), err_msg=name)


def test_columns_are_found_by_name_in_any_order(recording_stem: Path, layout: JointLayout) -> None:
    before = read_recording(recording_stem, layout)
    array, meta = read_array(recording_stem)
    order = np.random.default_rng(0).permutation(array.shape[1])
    columns = [tuple(meta["columns"][i].values()) for i in order]
    write_array(recording_stem.with_name("s2"), array[:, order], columns, META)
    after = read_recording(recording_stem.with_name("s2"), layout)
    np.testing.assert_array_equal(after.sensed.q, before.sensed.q)
    np.testing.assert_array_equal(after.truth.contact, before.truth.contact)


def test_every_column_has_one_name_unit_and_frame(layout: JointLayout) -> None:
    columns = [column for group in recording_columns(layout).values() for column in group]
    assert len({name for name, _, _ in columns}) == len(columns) == recording_width(layout)
    assert all(all(column) for column in columns)


def test_missing_column_is_named(recording_stem: Path, layout: JointLayout) -> None:
    array, meta = read_array(recording_stem)
    keep = [i for i, column in enumerate(meta["columns"]) if column["name"] != "tau_des.LL3"]
    columns = [tuple(meta["columns"][i].values()) for i in keep]
    write_array(recording_stem, array[:, keep], columns, META)
    with pytest.raises(
        DataError, match=r"s1\.parquet: column 'tau_des\.LL3' is missing; accepted: it, beside \d+ others: q"
    ):
        read_recording(recording_stem, layout)


def test_sensed_part_is_that_of_the_recording_and_needs_no_truth(recording_stem: Path, layout: JointLayout) -> None:
    recording = read_recording(recording_stem, layout)
    sensed_only = [(n, u, f) for field in list(recording_columns(layout).items())[:8] for n, u, f in field[1]]
    assert not [name for name, _, _ in sensed_only if name.startswith(("tau_ext", "wrench", "contact"))]
    array, meta = read_array(recording_stem, [name for name, _, _ in sensed_only])
    write_array(recording_stem.with_name("log"), array, sensed_only, {"rate_hz": meta["rate_hz"]})
    for stem in (recording_stem, recording_stem.with_name("log")):
        log = read_sensed(stem, layout)
        assert not hasattr(log, "truth")
        assert (log.segments, log.rate_hz) == (recording.segments, recording.rate_hz)
        for name, value in vars(recording.sensed).items():
            np.testing.assert_array_equal(getattr(log.sensed, name), value, err_msg=name)
    with pytest.raises(DataError, match=r"column 'tau_ext\.V1' is missing"):
        read_recording(recording_stem.with_name("log"), layout)


def test_parquet_alone_says_what_its_columns_are(recording_stem: Path, layout: JointLayout) -> None:
    schema = pq.read_schema(recording_stem.with_suffix(".parquet"))
    columns = [column for group in recording_columns(layout).values() for column in group]
    described = [(f.name, f.metadata[b"unit"].decode(), f.metadata[b"frame"].decode()) for f in schema]
    assert described == columns
    assert {str(field.type) for field in schema} == {"float"}
    frame = pd.read_parquet(recording_stem.with_suffix(".parquet"), columns=["tau_ext.LL3", "q.base_x"])
    np.testing.assert_array_equal(frame.to_numpy(), read_array(recording_stem, ["tau_ext.LL3", "q.base_x"])[0])


def test_wanted_columns_are_read_in_the_order_asked_for(recording_stem: Path) -> None:
    array, meta = read_array(recording_stem)
    names = [column["name"] for column in meta["columns"]]
    picked = np.random.default_rng(0).permutation(len(names))[:9]
    some, meta_again = read_array(recording_stem, [names[i] for i in picked])
    np.testing.assert_array_equal(some, array[:, picked])
    assert some.flags.c_contiguous
    assert meta_again == meta
    assert read_array(recording_stem, [])[0].shape == (len(array), 0)

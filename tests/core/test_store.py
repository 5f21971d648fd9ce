"""Result files are whole or absent, and a reader says what is wrong with a damaged one."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from mobnet.core.errors import DataError
from mobnet.core.joints import JointLayout
from mobnet.core.recording import Recording, recording_columns, recording_width
from mobnet.core.store import (
    atomic_path,
    read_array,
    read_json,
    read_recording,
    write_array,
    write_json,
    write_recording,
    write_text,
)

COLUMNS = [("a", "m", "world"), ("b", "rad", "joint")]
META = {"rate_hz": 1000.0}


@pytest.fixture
def array_stem(tmp_path: Path) -> Path:
    stem = tmp_path / "run" / "s1"
    write_array(stem, np.arange(20.0).reshape(10, 2), COLUMNS, META)
    return stem


@pytest.fixture
def recording_stem(tmp_path: Path, made_up: Callable[..., Recording], layout: JointLayout) -> Path:
    write_recording(tmp_path / "s1", made_up(seconds=0.2), layout)
    return tmp_path / "s1"


def test_array_round_trip_is_identity_in_float32(array_stem: Path) -> None:
    array, meta = read_array(array_stem)
    np.testing.assert_array_equal(array, np.arange(20.0, dtype=np.float32).reshape(10, 2))
    assert array.dtype == np.float32
    assert [column["name"] for column in meta["columns"]] == ["a", "b"]
    assert meta["segments"] == [[0, 10]]


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


def test_truncated_array_is_named(array_stem: Path) -> None:
    path = array_stem.with_suffix(".npy")
    path.write_bytes(path.read_bytes()[:-12])
    with pytest.raises(DataError, match=r"s1\.npy: truncated or damaged"):
        read_array(array_stem)


@pytest.mark.parametrize("content", [b"", b"not an array"])
def test_file_that_is_no_array_is_named(array_stem: Path, content: bytes) -> None:
    array_stem.with_suffix(".npy").write_bytes(content)
    with pytest.raises(DataError, match=r"s1\.npy: truncated or damaged"):
        read_array(array_stem)


def test_shape_that_disagrees_with_its_description_is_named(array_stem: Path) -> None:
    np.save(array_stem.with_suffix(".npy"), np.zeros((9, 2), dtype=np.float32))
    with pytest.raises(DataError, match=r"shape \(9, 2\), but s1\.json says \(10, 2\)"):
        read_array(array_stem)


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_value_that_is_not_finite_is_refused_by_writer_and_reader(array_stem: Path, value: float) -> None:
    array = np.zeros((10, 2), dtype=np.float32)
    array[7, 1] = value
    with pytest.raises(DataError, match=r"column 'b', row 7: -?(nan|inf) \(accepted: finite numbers\)"):
        write_array(array_stem.with_name("s2"), array, COLUMNS, META)
    assert not array_stem.with_name("s2.npy").exists()
    np.save(array_stem.with_suffix(".npy"), array)
    with pytest.raises(DataError, match=r"s1\.npy: column 'b', row 7"):
        read_array(array_stem)


@pytest.mark.parametrize("ending", [".npy", ".json"])
def test_missing_file_is_named(array_stem: Path, ending: str) -> None:
    array_stem.with_suffix(ending).unlink()
    with pytest.raises(DataError, match=rf"s1\{ending}: file is missing"):
        read_array(array_stem)


def test_json_that_is_damaged_is_named(tmp_path: Path) -> None:
    (tmp_path / "a.json").write_text('{"rows": ')
    with pytest.raises(DataError, match=r"a\.json: not JSON"):
        read_json(tmp_path / "a.json")


def test_missing_column_is_named(recording_stem: Path, layout: JointLayout) -> None:
    array, meta = read_array(recording_stem)
    keep = [i for i, column in enumerate(meta["columns"]) if column["name"] != "tau_des.LL3"]
    columns = [tuple(meta["columns"][i].values()) for i in keep]
    write_array(recording_stem, array[:, keep], columns, META)
    with pytest.raises(DataError, match=r"s1\.json: column 'tau_des\.LL3' is missing"):
        read_recording(recording_stem, layout)


def test_array_that_does_not_fit_its_columns_is_refused(tmp_path: Path) -> None:
    with pytest.raises(DataError, match=r"array of shape \(3, 3\), but 2 columns are named"):
        write_array(tmp_path / "s1", np.zeros((3, 3)), COLUMNS, META)
    assert not list(tmp_path.iterdir())


def test_failed_write_keeps_the_old_file_and_leaves_nothing_else(tmp_path: Path) -> None:
    path = tmp_path / "a.json"
    write_json(path, {"a": 1})
    with pytest.raises(ZeroDivisionError), atomic_path(path) as temporary:
        temporary.write_text(f"half {1 / 0}")
    assert read_json(path) == {"a": 1}
    assert list(tmp_path.iterdir()) == [path]


def test_writing_makes_folders_and_a_readable_file(tmp_path: Path) -> None:
    path = tmp_path / "new" / "folder" / "a.txt"
    write_text(path, "text")
    assert path.read_text() == "text"
    assert path.stat().st_mode & 0o444 == 0o444


WRITER = """
import sys, numpy as np
from pathlib import Path
from mobnet.core.store import write_array
for i in range(10**6):
    write_array(Path(sys.argv[1]), np.full((20000, 2), float(i)), [("a", "m", "w"), ("b", "m", "w")], {"rate_hz": 1.0})
    if i == 0:
        print("ready", flush=True)
"""


def test_kill_9_leaves_a_whole_array_or_none(tmp_path: Path) -> None:
    rng = np.random.default_rng(1)
    for i in range(5):
        stem = tmp_path / f"run{i}" / "s1"
        words = [sys.executable, "-c", WRITER, str(stem)]
        with subprocess.Popen(words, stdout=subprocess.PIPE, text=True) as process:
            assert process.stdout is not None
            assert process.stdout.readline() == "ready\n"
            time.sleep(rng.uniform(0.0, 0.05))
            process.send_signal(signal.SIGKILL)
        if stem.with_suffix(".json").exists():
            array, _ = read_array(stem)
            assert np.ptp(array) == 0.0


def test_description_is_written_after_the_array(array_stem: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: object) -> None:
        raise OSError("disk is full")

    monkeypatch.setattr("mobnet.core.store.write_json", fail)
    with pytest.raises(OSError, match="disk is full"):
        write_array(array_stem, np.zeros((5, 2)), COLUMNS, META)
    assert not array_stem.with_suffix(".json").exists()


def test_description_is_plain_json(array_stem: Path) -> None:
    meta = json.loads(array_stem.with_suffix(".json").read_text())
    assert meta["columns"][1] == {"name": "b", "unit": "rad", "frame": "joint"}

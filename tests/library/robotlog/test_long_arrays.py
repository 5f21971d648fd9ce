"""A long log lies in files in place of memory, and gives what it gives in the memory, to the byte."""

import errno
import os
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from mobnet.core.columns import recording_columns
from mobnet.core.errors import DataError
from mobnet.formats.loading import load_section
from mobnet.formats.robot import RobotTable
from mobnet.robot.description import describe
from mobnet.robotlog import long_arrays, pieces
from mobnet.robotlog.formats import read_log
from mobnet.robotlog.long_arrays import give_back, long_array
from mobnet.robotlog.observe import converted_log, observe_log

ROWS = 5000


@pytest.fixture
def in_files(monkeypatch, tmp_path):
    """Let every array of a log count as a large one, and give its pages back often; return the folder of the files."""
    monkeypatch.setattr(long_arrays, "LARGE_BYTES", 1)
    monkeypatch.setattr(pieces, "KEPT_ROWS", 1)
    return tmp_path / "files"


def jittered(table):
    apart = np.random.default_rng(3).uniform(-4e-4, 4e-4, len(table))
    return table.assign(time=np.sort(table["time"] + apart))


def with_truth(table):
    pushed = (np.arange(len(table)) // 500 % 3 == 1).astype(float)
    return table.assign(pushed=pushed, **{"tau_ext.J1": pushed, "tau_ext.J2": -2.0 * pushed})


@pytest.mark.parametrize("spoil", [with_truth, jittered], ids=["even", "interpolated"])
def test_a_log_in_files_gives_the_same_bytes(spoil, clean, arm, settings, in_files, tmp_path):
    spoil(clean[:ROWS]).to_parquet(tmp_path / "log.parquet")
    in_memory, stored = (
        observe_log(tmp_path / "log.parquet", arm, None, "sample", 100.0, 9.81, settings.robotlog, folder)
        for folder in (None, in_files)
    )
    assert stored.residual.tobytes() == in_memory.residual.tobytes()
    for name, values in vars(in_memory.converted.recording.sensed).items():
        assert getattr(stored.converted.recording.sensed, name).tobytes() == values.tobytes()
    for name, values in in_memory.converted.truth.items():
        assert stored.converted.truth[name].tobytes() == values.tobytes()
    assert (stored.hints, stored.explained) == (in_memory.hints, in_memory.explained)
    assert list(in_files.iterdir()) == []  # files have no name, so that none is left however the process ends


def test_a_floating_base_in_files_has_the_same_bytes(settings, in_files, tmp_path):
    robot = describe(load_section(Path("configs/robots/tocabi.yaml"), RobotTable))
    rng = np.random.default_rng(1)
    columns = {"time": np.arange(ROWS) / 1000.0 + rng.uniform(0.0, 4e-4, ROWS)}
    for name in ("q", "v", "acc_base_in_base", "tau_motor"):
        for column, *_ in recording_columns(robot.layout)[name]:
            columns[column] = rng.uniform(0.5, 1.0, ROWS)
    pd.DataFrame(columns).to_parquet(tmp_path / "log.parquet")
    in_memory, stored = (
        converted_log(tmp_path / "log.parquet", robot.layout, None, settings.robotlog, folder).recording.sensed
        for folder in (None, in_files)
    )
    for name, values in vars(in_memory).items():
        assert getattr(stored, name).tobytes() == values.tobytes()


def test_pages_that_were_given_back_keep_their_numbers(in_files):
    values = long_array((3, 4), in_files)
    values[:] = np.arange(12.0).reshape(3, 4)
    give_back()
    np.testing.assert_array_equal(values, np.arange(12.0).reshape(3, 4))


def failing(number):
    """Return a function that fails as the system does, with an error of a number."""

    def fail(*_):
        raise OSError(number, os.strerror(number))

    return fail


def test_where_no_file_can_be_mapped_an_array_lies_in_the_memory(in_files, monkeypatch):
    monkeypatch.setattr(long_arrays.mmap, "mmap", failing(errno.ENODEV))
    assert long_array((3, 4), in_files).shape == (3, 4)


def test_a_full_disk_is_one_line_before_anything_is_written(in_files, monkeypatch):
    monkeypatch.setattr(os, "posix_fallocate", failing(errno.ENOSPC))
    with pytest.raises(DataError, match=r"files: cannot be written: No space left on device; needed: "):
        long_array((3, 4), in_files)


def test_a_column_of_parquet_is_read_when_it_is_asked_for(clean, tmp_path):
    path = tmp_path / "log.parquet"
    clean[:ROWS].to_parquet(path)
    columns = read_log(path, ["time", "q.J1"])
    np.testing.assert_array_equal(columns["q.J1"].numbers(), clean["q.J1"][:ROWS])
    raw = bytearray(path.read_bytes())
    raw[10 : len(raw) // 2] = bytes(len(raw) // 2 - 10)  # its end, with the names of the columns, stays whole
    path.write_bytes(raw)
    with pytest.raises(DataError, match=r"log\.parquet: cannot be read as \.parquet: .*; accepted: a whole file"):
        columns["q.J1"].numbers()

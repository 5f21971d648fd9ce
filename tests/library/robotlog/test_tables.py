"""Parquet and files of arrays, as other programs write them."""

import weakref

import h5py
import numpy as np
import pyarrow as pa
import pytest
from pyarrow import parquet
from scipy.io import savemat
from scipy.io.matlab import MatlabOpaque

from mobnet.core.errors import DataError
from mobnet.formats.log_map import LogMap
from mobnet.robotlog.clocks import common_ticks
from mobnet.robotlog.formats import column_names, read_log
from mobnet.robotlog.observe import converted_log

T = np.arange(50) / 100
Q = np.stack([np.sin(T), np.cos(T)], axis=1)
ARRAYS = {"t": T, "q": Q, "v": 2 * Q, "tau": 3 * Q}
MAP = {"clock": {"column": "t"}, "q": {"columns": ("q",)}, "v": {"columns": ("v",)}, "tau_motor": {"columns": ("tau",)}}


def as_hdf5(path, arrays):
    with h5py.File(path, "w") as file:
        for name, values in arrays.items():
            file[name] = values
    return path


def as_compound(path):
    rows = np.zeros(len(T), dtype=[("t", "f8"), ("q", "f8", 2), ("v", "f4", 2), ("tau", "f8", 2)])
    for name, values in ARRAYS.items():
        rows[name] = values
    return as_hdf5(path, {"log": rows})


def as_npz(path):
    np.savez(path, note=np.array("a text is left out"), **ARRAYS)
    return path


def as_matlab(path):
    savemat(path, {"log": {name: values if values.ndim == 2 else values[:, None] for name, values in ARRAYS.items()}})
    return path


def as_simulink(path):
    """A structure with time, as a scope of Simulink stores it: an array of structures, one for each signal."""
    signals = np.zeros(3, dtype=[("values", "O"), ("label", "O")])
    for k, values in enumerate((Q, 2 * Q, 3 * Q)):
        signals[k] = (values, "abc"[k])
    scope = np.zeros(1, dtype=[("time", "O"), ("signals", "O")])
    scope[0] = (T[:, None], signals)
    savemat(path, {"ScopeData": scope})
    return path


def as_simulink_73(path):
    """The same as version 7.3 stores it: elements lie apart, and the array has references to them."""
    with h5py.File(path, "w") as file:
        file["out/logs/time"] = T[None, :]
        for k in range(3):
            file[f"#refs#/{k}"] = (k + 1) * Q.T
        values = np.array([[file[f"#refs#/{k}"].ref] for k in range(3)], dtype=h5py.ref_dtype)
        file.create_dataset("out/logs/signals/values", data=values)
    return path


SIMULINK = {"q": "signals/0/values", "v": "signals/1/values", "tau_motor": "signals/2/values", "t": "time"}
WRITERS = {
    "column vectors": lambda folder: as_hdf5(folder / "log.h5", ARRAYS | {"t": T[:, None]}),
    "an axis of one": lambda folder: as_hdf5(folder / "log.h5", ARRAYS | {"q": Q[:, None, :]}),
    "compound": lambda folder: as_compound(folder / "log.h5"),
    "MATLAB 7.3": lambda folder: as_hdf5(folder / "log.mat", {k: np.atleast_2d(own.T) for k, own in ARRAYS.items()}),
    "MATLAB 5": lambda folder: as_matlab(folder / "log.mat"),
    "Simulink": lambda folder: as_simulink(folder / "log.mat"),
    "Simulink 7.3": lambda folder: as_simulink_73(folder / "log.mat"),
    "NumPy": lambda folder: as_npz(folder / "log.npz"),
}
# Before the names of the arrays.
ABOVE = {"compound": "log.", "MATLAB 5": "log/", "Simulink": "ScopeData/", "Simulink 7.3": "out/logs/"}


@pytest.mark.parametrize("kind", WRITERS)
def test_arrays_are_columns_however_they_lie(kind, arm, settings, tmp_path):
    path, above = WRITERS[kind](tmp_path), ABOVE.get(kind, "")
    names = SIMULINK if kind.startswith("Simulink") else {"q": "q", "v": "v", "tau_motor": "tau", "t": "t"}
    mapping: dict = {key: {"columns": (above + names[key],)} for key in ("q", "v", "tau_motor")}
    mapping["clock"] = {"column": above + names["t"]}
    sensed = converted_log(path, arm.layout, LogMap.model_validate(mapping), settings.robotlog).recording.sensed
    np.testing.assert_allclose(sensed.q, Q, atol=1e-12)
    np.testing.assert_allclose(sensed.tau_motor, 3 * Q, atol=1e-12)


def test_cells_are_columns_by_number_and_objects_of_matlab_alone_are_one_line(tmp_path, monkeypatch):
    cells = np.zeros(2, dtype=object)
    cells[:] = [T, 2 * T]
    savemat(tmp_path / "log.mat", {"log": {"parts": cells}})
    assert column_names(tmp_path / "log.mat") == ["log/parts/0", "log/parts/1"]
    unknown = MatlabOpaque(np.zeros(1, dtype=[("s0", "O"), ("s1", "O"), ("s2", "O"), ("arr", "O")]))
    monkeypatch.setattr("scipy.io.loadmat", lambda *_, **__: {"__header__": b"", "None": unknown})
    with pytest.raises(DataError, match=r"holds objects, which MATLAB alone can read; accepted: structures and arrays"):
        column_names(tmp_path / "log.mat")


def test_arrays_of_different_lengths_are_one_line(arm, settings, tmp_path):
    path = as_hdf5(tmp_path / "log.h5", ARRAYS | {"v": Q[:-3]})
    with pytest.raises(
        DataError, match=r"column 'v\.0' has 47 rows, and the clock 50; accepted: columns of one length"
    ):
        converted_log(path, arm.layout, LogMap.model_validate(MAP), settings.robotlog)


def test_pictures_are_no_columns_and_arrays_beyond_the_memory_are_one_line(tmp_path):
    with h5py.File(tmp_path / "log.h5", "w") as file:
        file["t"] = T
        file.create_dataset("pictures", (50, 480, 640), "u1", chunks=(1, 480, 640))
        file.create_dataset("map", (5000, 5000), "f4", chunks=(500, 500))
        file.create_dataset("endless", (2, 10**11), "f8", chunks=(2, 1000))
    assert column_names(tmp_path / "log.h5") == ["endless.0", "endless.1", "t"]
    assert set(read_log(tmp_path / "log.h5", ["t"])) == {"t"}
    with pytest.raises(DataError, match=r"100000000000 rows x 1 columns x 8 B are 745\.1 GiB, and the memory has"):
        read_log(tmp_path / "log.h5", ["endless.0"])


def lists(values):
    return pa.FixedSizeListArray.from_arrays(pa.array(values.ravel()), 2)


@pytest.mark.parametrize("make", [lists, lambda values: pa.array(values.tolist())], ids=["fixed", "free"])
def test_lists_in_parquet_are_columns_by_number_and_episodes_are_segments(make, arm, settings, tmp_path):
    """As LeRobot writes them: the time of each episode begins at zero."""
    own = {"t": np.r_[T[:20], T[:30]].astype(np.float32), "q": make(Q), "v": make(2 * Q), "tau": make(3 * Q)}
    parquet.write_table(pa.table(own), tmp_path / "log.parquet")
    assert column_names(tmp_path / "log.parquet")[:3] == ["t", "q.0", "q.1"]
    found = converted_log(tmp_path / "log.parquet", arm.layout, LogMap.model_validate(MAP), settings.robotlog).recording
    assert found.segments == ((0, 20), (20, 50))
    np.testing.assert_allclose(found.sensed.v, 2 * Q, atol=1e-6)


def test_lists_of_several_lengths_are_one_line(tmp_path):
    parquet.write_table(pa.table({"t": T[:3], "q": [[1.0, 2.0], [1.0], None]}), tmp_path / "log.parquet")
    with pytest.raises(DataError, match=r"column 'q' has lists of 1 to 2 numbers; accepted: lists of one length"):
        read_log(tmp_path / "log.parquet", ["q.0"])


def test_durations_are_seconds_and_other_types_are_named(tmp_path):
    own = {"t": pa.array((T * 1e9).round().astype("i8"), pa.duration("ns")), "q": T, "note": ["x"] * len(T)}
    parquet.write_table(pa.table(own), tmp_path / "log.parquet")
    np.testing.assert_allclose(read_log(tmp_path / "log.parquet")["t"].numbers(), T, atol=1e-9)
    with pytest.raises(DataError, match="column 'note' holds string; accepted: numbers, dates as"):
        read_log(tmp_path / "log.parquet", ["note"])


def test_columns_go_with_the_signals_that_are_made_of_them(tmp_path, arm, settings, monkeypatch):
    """A long log would else be in memory twice."""
    signals = {f"{name}.{k}": ARRAYS[name][:, k] for name in ("q", "v", "tau") for k in range(2)}
    np.savez(tmp_path / "log.npz", t=T, **signals)
    held = list[weakref.ref[np.ndarray]]()
    left = list[int]()

    def reading(*given):
        columns = read_log(*given)
        held.extend(weakref.ref(column.values) for column in columns.values())
        return columns

    def ticks(*given):
        left.append(sum(values() is not None for values in held))
        return common_ticks(*given)

    monkeypatch.setattr("mobnet.robotlog.observe.read_log", reading)
    monkeypatch.setattr("mobnet.robotlog.convert.common_ticks", ticks)
    converted_log(tmp_path / "log.npz", arm.layout, LogMap.model_validate(MAP), settings.robotlog)
    assert len(held) == 7
    assert left == [0]

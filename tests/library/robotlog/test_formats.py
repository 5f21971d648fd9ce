"""One recording in every format gives one residual."""

import importlib
import re

import numpy as np
import pytest
from made_logs import (
    JOINTS,
    SIGNALS,
    TOPIC,
    as_bag1,
    as_bag2,
    as_bag2_mcap,
    as_csv,
    as_hdf5,
    as_json_mcap,
    as_mcap,
    as_parquet,
    as_ros1_mcap,
)

from mobnet.core.errors import DataError
from mobnet.formats.log_map import LogMap
from mobnet.robotlog.formats import column_names, read_log
from mobnet.robotlog.observe import observe_log

ROWS = 1500
PLAIN = {name: [f"{name}.{joint}" for joint in JOINTS] for name in SIGNALS}
HDF5 = {"clock": {"column": "clock/t"}, **{name: {"columns": [f"arm/{name}"]} for name in PLAIN}}
FORMATS = {  # and their maps; None: columns have the names that need no map
    as_csv: None,
    as_parquet: None,
    as_hdf5: HDF5,
    as_mcap: None,
    as_json_mcap: None,
    as_ros1_mcap: None,
    as_bag1: None,
    as_bag2: None,
    as_bag2_mcap: None,
}


@pytest.fixture(scope="module")
def observed(arm, settings):
    """Return a function that observes a log."""

    def observe(path, mapping=None):
        meaning = None if mapping is None else LogMap.model_validate(mapping)
        return observe_log(path, arm, meaning, "sample", 100.0, 9.81, settings.robotlog)

    return observe


@pytest.fixture(scope="module")
def reference(clean, observed, tmp_path_factory):
    given = {name: {"columns": tuple(own)} for name, own in PLAIN.items()}
    return observed(as_csv(clean[:ROWS], tmp_path_factory.mktemp("csv")), given).residual


@pytest.mark.parametrize("write", FORMATS, ids=lambda write: write.__name__)
def test_every_format_gives_the_residual_of_the_csv(write, clean, observed, reference, tmp_path):
    found = observed(write(clean[:ROWS], tmp_path), FORMATS[write])
    assert not found.converted.interpolated
    assert found.converted.hints == ()
    np.testing.assert_allclose(found.residual, reference, atol=1e-6)


def test_columns_of_messages_have_the_names_of_joints(clean, tmp_path):
    path = as_bag2(clean[:10], tmp_path)
    own = {f"{TOPIC}.{field}.{joint}" for field in SIGNALS.values() for joint in JOINTS}
    assert set(column_names(path)) == own
    assert set(read_log(path)) == own


def test_only_what_is_wanted_is_read(clean, tmp_path):
    for write in (as_csv, as_parquet, as_hdf5, as_bag1):
        path = write(clean[:10], tmp_path)
        one = column_names(path)[2]
        assert set(read_log(path, [one])) == {one}


def test_texts_are_left_out_and_named_if_wanted(clean, tmp_path):
    path = as_csv(clean[:10].assign(note="x"), tmp_path)
    assert set(read_log(path)) == set(clean)
    with pytest.raises(
        DataError, match=r"log\.csv: column 'note' holds text, 'x' in row 0; accepted: numbers, dates as"
    ):
        read_log(path, ["q.J1", "note"])


def test_a_csv_of_texts_alone_holds_no_column_of_numbers(tmp_path):
    path = tmp_path / "log.csv"
    path.write_text("mode,name\na,b\nc,d\n")
    with pytest.raises(DataError, match=r"log.csv: holds no column of numbers"):
        read_log(path)


def test_a_csv_may_have_other_separators_empty_fields_whole_numbers_and_dates(tmp_path):
    path = tmp_path / "log.csv"
    rows = "".join(f"2026-01-02T03:04:05.{k:03d}; {k}; {k if k % 2 else ''}\n" for k in range(1000))
    path.write_text("\ufeff" + "t; whole; sparse\n" + rows + "2026-01-02T03:04:06.000;0.5;1\n")
    read = read_log(path)
    np.testing.assert_allclose(np.diff(read["t"].numbers()), 1e-3, atol=1e-6)
    assert read["whole"].numbers()[-1] == 0.5
    assert np.isnan(read["sparse"].numbers()).sum() == 500
    path.write_text("a,b,a\n1,2,3\n")
    with pytest.raises(DataError, match="column 'a' stands twice in the header"):
        read_log(path)


@pytest.mark.parametrize("name", ["log.csv", "log.parquet", "log.h5", "log.mcap", "log.bag"])
def test_a_damaged_file_is_one_line(name, tmp_path):
    (tmp_path / name).write_bytes(b"\x00garbage\xff" * 20)
    with pytest.raises(DataError, match=rf"^{tmp_path}/{name}: [^\n]+; accepted: [^\n]+$"):
        read_log(tmp_path / name)


def cut(path, share=0.5):
    """Leave out the end of a file, or of that with the messages in a folder."""
    whole = next(file for file in path.iterdir() if file.suffix != ".yaml") if path.is_dir() else path
    whole.write_bytes(whole.read_bytes()[: int(share * whole.stat().st_size)])
    return path


@pytest.mark.parametrize("write", [as_parquet, as_hdf5, as_bag1, as_bag2], ids=lambda write: write.__name__)
def test_a_file_that_ends_early_is_one_line(write, clean, tmp_path):
    with pytest.raises(DataError, match=r"^[^\n]+$"):
        read_log(cut(write(clean[:200], tmp_path)))


def test_a_bag_of_ros_1_that_was_not_closed_names_what_mends_it(clean, tmp_path):
    path = as_bag1(clean[:200], tmp_path)
    for name in ("log.bag", "log.bag.active"):
        with pytest.raises(DataError, match=r"rosbag reindex"):
            read_log(cut(path.rename(tmp_path / name)))


@pytest.mark.parametrize("write", [as_csv, as_json_mcap, as_mcap, as_bag2_mcap], ids=lambda write: write.__name__)
def test_a_log_that_ends_early_is_read_as_far_as_it_is_whole(write, clean, observed, tmp_path):
    path = cut(write(clean[:800], tmp_path), 0.6)
    found = observed(path).converted
    rows = len(found.recording.sensed)
    assert 300 < rows < 600
    np.testing.assert_allclose(found.recording.sensed.q[:, 1], clean["q.J2"][:rows], atol=1e-6)
    assert len(found.hints) == 1
    assert re.search(
        r"ends early: read as far as it is whole|1 row left out, .* the last row may be cut", found.hints[0]
    )


def test_an_unknown_format_and_a_missing_file_name_what_is_accepted(tmp_path):
    (tmp_path / "log.json").write_text("")
    with pytest.raises(DataError, match=r"format: '\.json' is not accepted; accepted: .*\.csv.*a folder of `ros2 bag`"):
        read_log(tmp_path / "log.json")
    with pytest.raises(DataError, match=r"none\.csv: file is missing; accepted: a log, \.csv, \.tsv"):
        read_log(tmp_path / "none.csv")


def external(file, path):
    """Add a dataset whose numbers are the bytes of another file."""
    file.create_dataset("arm/x", (2,), "f8", external=[(str(path), 0, 16)])


def virtual(file, path):
    """Add a dataset whose numbers are those of another HDF5 file."""
    h5py = importlib.import_module("h5py")
    source = h5py.VirtualSource(str(path), "x", (2,), "f8")
    layout = h5py.VirtualLayout((2,), "f8")
    layout[:] = source
    file.create_virtual_dataset("arm/x", layout)


@pytest.mark.parametrize("add", [external, virtual], ids=lambda add: add.__name__)
def test_an_hdf5_file_that_takes_numbers_from_other_files_is_refused(add, clean, tmp_path):
    h5py, secret = importlib.import_module("h5py"), tmp_path / "secret"
    with h5py.File(secret, "w") as file:
        file["x"] = np.arange(2.0)
    log = as_hdf5(clean[:ROWS], tmp_path)
    with h5py.File(log, "a") as file:
        add(file, secret)
    for read in (column_names, read_log):
        with pytest.raises(
            DataError, match=r"log.h5: 'arm/x' takes its numbers from other files; accepted: a file that"
        ):
            read(log)

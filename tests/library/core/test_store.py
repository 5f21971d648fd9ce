"""Result files are whole or absent, and a reader says what is wrong with a damaged one."""

import json
import signal
import subprocess
import sys
import time
from collections.abc import Iterable
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from mobnet.core.errors import DataError
from mobnet.core.store import GROUP_ROWS, array_writer, footer_hash, read_array, write_array

COLUMNS = [("a", "m", "world"), ("b", "rad", "joint")]
META = {"rate_hz": 1000.0}
ROUND_TRIP = """
import sys
from pathlib import Path
import numpy as np
from mobnet.core.store import read_array, write_array
write_array(Path("s1"), np.zeros((3, 1)), [("a", "m", "world")], {"rate_hz": 1000.0})
read_array(Path("s1"))
print(*sys.modules)
"""


@pytest.fixture
def array_stem(tmp_path: Path) -> Path:
    stem = tmp_path / "run" / "s1"
    write_array(stem, np.arange(20.0).reshape(10, 2), COLUMNS, META)
    return stem


def test_the_array_of_another_note_is_refused(tmp_path: Path) -> None:
    rng = np.random.default_rng(1)
    for name in ("one", "other"):
        write_array(tmp_path / name, rng.normal(size=(500, 2)), COLUMNS[:2], {"rate_hz": 1000.0})
        read_array(tmp_path / name)
    (tmp_path / "one.parquet").write_bytes((tmp_path / "other.parquet").read_bytes())
    with pytest.raises(DataError, match=r"one\.parquet: hash of the footer: .* as one\.json says"):
        read_array(tmp_path / "one")


def test_arrays_are_written_and_read_without_pandas_whose_import_takes_a_second(tmp_path: Path) -> None:
    done = subprocess.run([sys.executable, "-c", ROUND_TRIP], cwd=tmp_path, capture_output=True, text=True, check=True)
    assert "pandas" not in done.stdout.split()


@pytest.mark.parametrize("rows", [1, GROUP_ROWS - 1, GROUP_ROWS, GROUP_ROWS + 1])
def test_array_round_trip_is_identity_in_float32_and_gives_the_same_bytes_again(tmp_path: Path, rows: int) -> None:
    array = np.arange(rows)[:, None] * [1.0, -2.0]
    write_array(tmp_path / "s1", array, COLUMNS, META)
    written = (tmp_path / "s1.parquet").read_bytes()
    read, meta = read_array(tmp_path / "s1")
    np.testing.assert_array_equal(read, array.astype(np.float32))
    assert read.dtype == np.float32
    assert read.flags.c_contiguous
    columns = [{"name": "a", "unit": "m", "frame": "world"}, {"name": "b", "unit": "rad", "frame": "joint"}]
    assert meta.pop("footer") == footer_hash(tmp_path / "s1.parquet")
    assert meta == {"rows": rows, "segments": [[0, rows]], "rate_hz": 1000.0, "columns": columns}
    write_array(tmp_path / "s1", array, COLUMNS, META)
    assert (tmp_path / "s1.parquet").read_bytes() == written


def foreign(path: Path, array: np.ndarray, names: str = "ab") -> None:
    """Write a parquet file as somebody else's program would."""
    pq.write_table(pa.table(dict(zip(names, array.T, strict=True))), path)
    note = json.loads(path.with_suffix(".json").read_text())
    path.with_suffix(".json").write_text(json.dumps({key: note[key] for key in note if key != "footer"}))


@pytest.mark.parametrize("kept", [0, 3, 100, -12, -1, None])
def test_truncated_array_and_a_file_that_is_none_are_named(array_stem: Path, kept: int | None) -> None:
    path = array_stem.with_suffix(".parquet")
    path.write_bytes(b"not an array" if kept is None else path.read_bytes()[:kept])
    with pytest.raises(DataError, match=r"s1\.parquet: truncated or damaged \(.+\); accepted: a whole Parquet file$"):
        read_array(array_stem)


def test_any_damaged_sample_is_noticed(tmp_path: Path) -> None:
    array = np.random.default_rng(0).normal(size=(300, 2)).astype(np.float32)
    write_array(tmp_path / "s1", array, COLUMNS, META)
    path = tmp_path / "s1.parquet"
    whole = path.read_bytes()
    for place in range(100, 2200, 300):  # amid the numbers of either column
        path.write_bytes(whole[:place] + bytes([whole[place] ^ 1]) + whole[place + 1 :])
        with pytest.raises(DataError, match=r"s1\.parquet: truncated or damaged"):
            read_array(tmp_path / "s1")


def test_array_that_disagrees_with_its_description_is_named(array_stem: Path) -> None:
    foreign(array_stem.with_suffix(".parquet"), np.zeros((9, 2)))
    with pytest.raises(DataError, match=r"shape \(9, 2\) is not accepted; accepted: \(10, 2\), as s1\.json says"):
        read_array(array_stem)
    foreign(array_stem.with_suffix(".parquet"), np.zeros((10, 2)), "ac")
    with pytest.raises(DataError, match=r"s1\.parquet: column: 'c' is not accepted; accepted: b, those that"):
        read_array(array_stem, ["a"])


def test_columns_may_stand_in_any_order(array_stem: Path) -> None:
    path, (before, _) = array_stem.with_suffix(".parquet"), read_array(array_stem)
    note = json.loads(array_stem.with_suffix(".json").read_text())
    del note["footer"]
    array_stem.with_suffix(".json").write_text(json.dumps(note))
    pq.write_table(pq.read_table(path).select(["b", "a"]), path)
    np.testing.assert_array_equal(read_array(array_stem)[0], before)


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf, 1e300])
def test_value_that_is_not_finite_is_refused_by_writer_and_reader(array_stem: Path, value: float) -> None:
    array = np.zeros((10, 2))
    array[7, 1] = value
    before = array_stem.with_suffix(".parquet").read_bytes()
    with pytest.raises(DataError, match=r"s1\.parquet: column 'b', row 7: -?(nan|inf) is not accepted; accepted: fini"):
        write_array(array_stem, array, COLUMNS, META)
    assert array_stem.with_suffix(".parquet").read_bytes() == before
    foreign(array_stem.with_suffix(".parquet"), array)
    with pytest.raises(DataError, match=r"s1\.parquet: column 'b', row 7"):
        read_array(array_stem, ["b"])
    assert not read_array(array_stem, ["a"])[0].any()


@pytest.mark.parametrize("ending", [".parquet", ".json"])
def test_missing_file_is_named(array_stem: Path, ending: str) -> None:
    array_stem.with_suffix(ending).unlink()
    with pytest.raises(DataError, match=rf"s1\{ending}: file is missing"):
        read_array(array_stem)


def pieces(array: np.ndarray, rng: np.random.Generator) -> list[np.ndarray]:
    """Cut an array into pieces of random length, some of them empty."""
    return np.split(array, np.sort(rng.integers(0, len(array), 7)))


def stream(
    stem: Path,
    pieces: Iterable[np.ndarray],
    after: Iterable[np.ndarray] = (),
    segments: list[tuple[int, int]] | None = None,
    closed: bool = True,
) -> None:
    """Append pieces, close, append what comes after that."""
    with array_writer(stem, COLUMNS) as writer:
        for piece in pieces:
            writer.append(piece)
        if closed:
            writer.close(META, segments)
        for piece in after:
            writer.append(piece)


def test_streamed_array_is_the_same_file_as_a_whole_one(tmp_path: Path) -> None:
    """Writing in pieces and at once are equivalent to the byte."""
    rng = np.random.default_rng(3)
    array = rng.normal(size=(2 * GROUP_ROWS + 17, 2)).astype(np.float32)
    write_array(tmp_path / "whole", array, COLUMNS, META, [(0, 5), (5, len(array))])
    stream(tmp_path / "streamed", pieces(array, rng), segments=[(0, 5), (5, len(array))])
    for ending in (".parquet", ".json"):
        one, two = (tmp_path.joinpath(name + ending).read_bytes() for name in ("whole", "streamed"))
        assert one == two
    np.testing.assert_array_equal(read_array(tmp_path / "streamed")[0], array)
    assert pq.read_metadata(tmp_path / "streamed.parquet").num_row_groups == 3


def test_what_does_not_fit_the_columns_or_is_not_finite_in_any_piece_is_refused(tmp_path: Path) -> None:
    with pytest.raises(DataError, match=r"array of shape \(3, 3\), but 2 columns are named"):
        write_array(tmp_path / "s1", np.zeros((3, 3)), COLUMNS, META)
    array = np.zeros((3 * 700, 2), dtype=np.float32)
    array[1999, 0] = np.nan
    with pytest.raises(DataError, match="column 'a', row 1999: nan"):
        stream(tmp_path / "s1", np.split(array, 3))
    assert not list(tmp_path.iterdir())


def test_nothing_appears_when_the_block_does_not_end_well(array_stem: Path) -> None:
    files = {path: path.read_bytes() for path in array_stem.parent.iterdir()}
    row = np.zeros((1, 2))
    with pytest.raises(ZeroDivisionError):
        stream(array_stem, (row * (1 // (3 - i)) for i in range(9)))
    with pytest.raises(DataError, match="must follow the last of its 1 rows"):
        stream(array_stem, [row], closed=False)
    with pytest.raises(DataError, match="must follow the last of its 3 rows"):
        stream(array_stem, [row, row], [row])
    assert {path: path.read_bytes() for path in array_stem.parent.iterdir()} == files


def test_only_wanted_columns_are_read(tmp_path: Path) -> None:
    array = np.random.default_rng(0).normal(size=(300, 2))
    write_array(tmp_path / "s1", array, COLUMNS, META)
    path = tmp_path / "s1.parquet"
    path.write_bytes(path.read_bytes()[:100] + bytes(50) + path.read_bytes()[150:])  # amid the first column
    np.testing.assert_array_equal(read_array(tmp_path / "s1", ["b"])[0][:, 0], array[:, 1].astype(np.float32))
    with pytest.raises(DataError, match="damaged"):
        read_array(tmp_path / "s1", ["a"])


WRITER = """
import sys, numpy as np
from pathlib import Path
from mobnet.core.store import write_array
for i in range(10**6):
    write_array(Path(sys.argv[1]), np.full((80000, 2), float(i)), [("a", "m", "w"), ("b", "m", "w")], {"rate_hz": 1.0})
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

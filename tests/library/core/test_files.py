"""A file is the old one or the whole new one."""

import errno
import os
from collections.abc import Callable
from pathlib import Path

import pytest

from mobnet.core.errors import DataError
from mobnet.core.files import PARTIAL, atomic_path, check_place, read_json, read_text, sweep, write_json, write_text


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


@pytest.mark.parametrize("number", [errno.ENOSPC, errno.EDQUOT, errno.EROFS, errno.EACCES])
def test_what_cannot_be_written_is_one_line(tmp_path: Path, number: int) -> None:
    with pytest.raises(DataError) as told, atomic_path(tmp_path / "a.txt", 2**60) as temporary:
        raise OSError(number, os.strerror(number), str(temporary))
    assert str(told.value).startswith(f"{tmp_path}/a.txt: cannot be written: {os.strerror(number)}; ")
    full = number in (errno.ENOSPC, errno.EDQUOT)
    assert ("needed: 1099511627776.000 MiB, free: " in str(told.value)) == full
    assert list(tmp_path.iterdir()) == []


def test_a_file_in_place_of_a_folder_is_named(tmp_path: Path) -> None:
    (tmp_path / "a").touch()
    with pytest.raises(DataError, match=rf"a/b/c\.txt: cannot be written: Not a directory \({tmp_path}/a/b\)"):
        write_text(tmp_path / "a/b/c.txt", "text")


@pytest.mark.parametrize("content", [b"[1]", b"\xff", b"1" * 5000 + b"x"])
def test_what_is_no_json_object_is_refused(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "a.json").write_bytes(content)
    with pytest.raises(DataError, match=r"a\.json: "):
        read_json(tmp_path / "a.json")


@pytest.mark.parametrize("read", [read_text, read_json])
def test_a_missing_file_and_damaged_json_are_named(tmp_path: Path, read: Callable[[Path], object]) -> None:
    with pytest.raises(DataError, match=r"a\.json: file is missing"):
        read(tmp_path / "a.json")
    (tmp_path / "a.json").write_text('{"rows": ')
    with pytest.raises(DataError, match=r"a\.json: not JSON"):
        read_json(tmp_path / "a.json")


def test_what_a_killed_command_left_is_swept_and_what_is_being_written_stays(tmp_path: Path) -> None:
    left = tmp_path / f"{PARTIAL}abc.log.csv"
    left.write_text("half")
    with atomic_path(tmp_path / "new.csv") as temporary:
        temporary.write_text("whole")
        sweep(tmp_path)
        assert not left.exists()
        assert temporary.exists()
    sweep(tmp_path / "not there")
    assert [path.name for path in tmp_path.iterdir()] == ["new.csv"]


def test_a_place_is_checked_without_a_trace(tmp_path: Path) -> None:
    check_place(tmp_path / "a" / "b")
    assert list(tmp_path.iterdir()) == []
    (tmp_path / "file").touch()
    with pytest.raises(DataError, match=r"file: cannot be written: "):
        check_place(tmp_path / "file" / "b")

"""A file is the old one or the whole new one."""

from collections.abc import Callable
from pathlib import Path

import pytest

from mobnet.core.errors import DataError
from mobnet.core.files import atomic_path, read_json, read_text, write_json, write_text


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


@pytest.mark.parametrize("read", [read_text, read_json])
def test_a_missing_file_and_damaged_json_are_named(tmp_path: Path, read: Callable[[Path], object]) -> None:
    with pytest.raises(DataError, match=r"a\.json: file is missing"):
        read(tmp_path / "a.json")
    (tmp_path / "a.json").write_text('{"rows": ')
    with pytest.raises(DataError, match=r"a\.json: not JSON"):
        read_json(tmp_path / "a.json")

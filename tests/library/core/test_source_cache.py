"""What was read of the code is kept between processes, for exactly these files."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from mobnet.core import source, source_cache
from mobnet.core.source import CodePart
from mobnet.core.source_cache import Keeper

CACHED = (source.read, source.read_declared, source.module_files, source.declared_parts)
ONE = "from mobnet import two\nfrom mobnet.settings.base import Section\nvalue = Section\n"


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """The sources of a project with a folder for what is kept."""
    texts = {
        "mobnet/one.py": ONE,
        "mobnet/two.py": "import numpy\n",
        "mobnet/settings/base.py": "class Section: a = 1\n",
    }
    for name, text in texts.items():
        (tmp_path / "src" / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / "src" / name).write_text(text)
    (tmp_path / ".cache").mkdir()
    monkeypatch.setattr(source, "SOURCE", tmp_path / "src")
    for function in CACHED:
        function.cache_clear()
    yield tmp_path / "src"
    for function in CACHED:
        function.cache_clear()


def parts_of(folder: Path) -> list[CodePart]:
    return [CodePart(folder / "mobnet/one.py"), CodePart(folder / "mobnet/settings/base.py", "Section", is_type=True)]


def kept_in(folder: Path, monkeypatch: pytest.MonkeyPatch) -> Keeper:
    """Return what another process finds; it must not read anything itself."""

    def refuse(part: CodePart) -> None:
        raise AssertionError(part)

    monkeypatch.setattr(source, "read", refuse)
    return Keeper(folder)


def test_another_process_gets_the_same_and_reads_nothing(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    first = Keeper(folder)
    read = [first.read(part) for part in parts_of(folder)]
    assert read == [source.read(part) for part in parts_of(folder)]
    assert {"numpy"} == set().union(*(source.read(part).packages for part in read[0].parts))
    first._store()
    then = kept_in(folder, monkeypatch)
    assert [then.read(part) for part in parts_of(folder)] == read


@pytest.mark.parametrize("change", ["another byte", "another file", "damaged"])
def test_of_other_sources_and_of_a_damaged_file_nothing_is_taken(
    folder: Path, monkeypatch: pytest.MonkeyPatch, change: str
) -> None:
    first = Keeper(folder)
    first.read(parts_of(folder)[0])
    first._store()
    if change == "another byte":
        (folder / "mobnet/two.py").write_text("import scipy\n")
    elif change == "another file":
        (folder / "mobnet/three.py").touch()
    else:
        (folder.parent / ".cache" / "source.json").write_text('{"state": ')
    with pytest.raises(AssertionError):
        kept_in(folder, monkeypatch).read(parts_of(folder)[0])


def test_nothing_is_kept_of_scripts_and_where_no_project_is(folder: Path) -> None:
    script = folder.parent / "script.py"
    script.write_text("from mobnet import one\n")
    assert source_cache.read(CodePart(script)) == source.read(CodePart(script))
    assert CodePart(script) not in source_cache.keeper(folder)._kept
    (folder.parent / ".cache").rmdir()
    assert source_cache.read(parts_of(folder)[0]) == source.read(parts_of(folder)[0])
    assert not (folder.parent / ".cache").exists()

"""The hash of the code behind a rule changes with what the code does, and with nothing else."""

from __future__ import annotations

from pathlib import Path

import pytest

from mobnet.core import code
from mobnet.core.code import code_hash, module_files


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A package of three modules: one -> two; three stands alone."""
    folder = tmp_path / "mobnet"
    folder.mkdir()
    (folder / "__init__.py").write_text('"""Root."""\n')
    (folder / "one.py").write_text(
        '"""One."""\nfrom mobnet.two import f\n\n\ndef g():\n    """Text."""\n    return f()\n'
    )
    (folder / "two.py").write_text("def f():\n    return 1\n")
    (folder / "three.py").write_text("x = 1\n")
    (tmp_path / "script.py").write_text("from mobnet import one\n")
    monkeypatch.setattr(code, "SOURCE", tmp_path)
    return folder


def hash_after(package: Path, name: str, text: str) -> str:
    """Return the script's hash after a module's text was replaced."""
    (package / name).write_text(text)
    code.reading.cache_clear()
    return code_hash(package.parent / "script.py")


def test_docstrings_comments_and_layout_do_not_count(package: Path) -> None:
    """The hash is invariant to what does not run."""
    before = code_hash(package.parent / "script.py")
    text = '"""Other."""\n# a comment\nfrom mobnet.two import f\n\ndef g():\n    "New text."\n    return f(  )\n'
    assert hash_after(package, "one.py", text) == before


def test_an_edit_anywhere_below_the_script_counts(package: Path) -> None:
    before = code_hash(package.parent / "script.py")
    assert hash_after(package, "two.py", "def f():\n    return 2\n") != before


def test_an_edit_elsewhere_does_not_count(package: Path) -> None:
    before = code_hash(package.parent / "script.py")
    assert hash_after(package, "three.py", "x = 2\n") == before


def test_an_import_inside_a_function_counts(package: Path) -> None:
    lazy = "def g():\n    from mobnet.three import x\n    return x\n"
    before = hash_after(package, "one.py", lazy)
    assert hash_after(package, "three.py", "x = 2\n") != before


def test_packages_on_the_way_count() -> None:
    names = [file.name for file in module_files("mobnet.core.files.write_json")]
    assert names == ["__init__.py", "__init__.py", "files.py"]


def test_notes_of_provenance_do_not_count() -> None:
    assert "provenance.py" not in [file.name for file in module_files("mobnet.core.provenance.provenance")]

"""The cache of compiled code follows every source file of the compiled packages."""

from __future__ import annotations

from pathlib import Path

import numba
import pytest

from mobnet.control import compiled as module
from mobnet.control.compiled import PACKAGES, compiled, source_hash


def test_hash_changes_with_any_compiled_source_and_nothing_else(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    root = tmp_path / "package"
    for package in (*PACKAGES, "learning"):
        (root / package).mkdir(parents=True)
        (root / package / "code.py").write_text("x = 1\n")
    monkeypatch.setattr(module, "__file__", str(root / "control" / "compiled.py"))
    before = source_hash()
    (root / "learning" / "code.py").write_text("x = 2\n")
    assert source_hash() == before
    for package in PACKAGES:
        (root / package / "code.py").write_text("x = 2\n")
        assert source_hash() != before
        before = source_hash()


def test_cache_lies_in_a_folder_named_after_the_hash() -> None:
    assert Path(numba.config.CACHE_DIR).name == source_hash()


def test_compiled_code_divides_by_zero_as_numpy_does() -> None:
    assert compiled(lambda x: 1.0 / x)(0.0) == float("inf")

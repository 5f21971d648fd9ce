"""The manifest finds every file that is missing or changed, and sha256sum reads it."""

from __future__ import annotations

import hashlib
import subprocess
from pathlib import Path

import pytest

from mobnet.core.errors import DataError
from mobnet.evaluation.report.manifest import damaged_files, file_hash, write_manifest


@pytest.fixture
def files(tmp_path: Path) -> list[Path]:
    paths = [tmp_path / "b.parquet", tmp_path / "a.csv"]
    for path in paths:
        path.write_bytes(path.name.encode() * 1000)
    write_manifest(paths, tmp_path / "MANIFEST.sha256")
    return paths


def test_whole_files_have_no_fault(files: list[Path]) -> None:
    assert damaged_files(files[0].parent / "MANIFEST.sha256") == []


def test_one_flipped_bit_and_a_missing_file_are_named(files: list[Path]) -> None:
    content = bytearray(files[0].read_bytes())
    content[7] ^= 1
    files[0].write_bytes(content)
    files[1].unlink()
    missing, changed = damaged_files(files[0].parent / "MANIFEST.sha256")
    assert missing == f"{files[1]}: file is missing"
    assert changed.startswith(f"{files[0]}: hash ")


@pytest.mark.parametrize("ending", ["parquet", "json", "safetensors", "csv", "tex", "md", "png", "pdf", "html"])
@pytest.mark.parametrize("place", [0, 500, 999])
def test_one_flipped_byte_anywhere_in_any_file_is_found_and_only_its_file_is_named(
    tmp_path: Path, ending: str, place: int
) -> None:
    paths = [tmp_path / f"{name}.{ending}" for name in ("whole", "flipped", "other")]
    for path in paths:
        path.write_bytes(bytes(range(250)) * 4)
    write_manifest(paths, tmp_path / "MANIFEST.sha256")
    content = bytearray(paths[1].read_bytes())
    content[place] ^= 0xFF
    paths[1].write_bytes(content)
    (fault,) = damaged_files(tmp_path / "MANIFEST.sha256")
    assert fault.startswith(f"{paths[1]}: hash ")


def test_order_of_files_does_not_matter(files: list[Path]) -> None:
    manifest = files[0].parent / "MANIFEST.sha256"
    before = manifest.read_bytes()
    write_manifest([*reversed(files), files[0]], manifest)
    assert manifest.read_bytes() == before


def test_hash_is_the_reference_sha256(files: list[Path]) -> None:
    assert file_hash(files[0]) == hashlib.sha256(files[0].read_bytes()).hexdigest()
    subprocess.run(["sha256sum", "--check", "--quiet", "MANIFEST.sha256"], cwd=files[0].parent, check=True)


def test_missing_manifest_and_missing_result_are_named(tmp_path: Path) -> None:
    with pytest.raises(DataError, match=r"MANIFEST\.sha256: file is missing; \./reproduce all writes it"):
        damaged_files(tmp_path / "MANIFEST.sha256")
    with pytest.raises(DataError, match=r"none\.parquet: file is missing"):
        write_manifest([tmp_path / "none.parquet"], tmp_path / "MANIFEST.sha256")
    assert not (tmp_path / "MANIFEST.sha256").exists()

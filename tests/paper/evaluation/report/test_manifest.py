"""The manifest finds every file that is missing or changed, and sha256sum reads it."""

import subprocess
from pathlib import Path

import pytest

from experiments.evaluation.report.manifest import TIMES, differences, manifest, write_lists
from mobnet.core.errors import DataError
from mobnet.core.files import write_text

ENDINGS = ["parquet", "json", "safetensors", "csv", "tex", "md", "png", "svg", "pdf", "html"]


@pytest.fixture
def files(tmp_path: Path) -> list[Path]:
    """Files of every kind, and beside them their manifest."""
    paths = [tmp_path / f"result.{ending}" for ending in ENDINGS]
    for path in paths:
        path.write_bytes(bytes(range(250)) * 4)
    write_lists(paths[:-1], paths[-1:], tmp_path / "MANIFEST.sha256")
    return paths


def test_whole_files_have_no_fault_for_us_and_for_sha256sum(files: list[Path]) -> None:
    """The reference implementation reads the same hashes."""
    assert differences(files[0].parent / "MANIFEST.sha256") == []
    subprocess.run(["sha256sum", "--check", "--quiet", "MANIFEST.sha256", TIMES], cwd=files[0].parent, check=True)


@pytest.mark.parametrize("flipped", range(len(ENDINGS)), ids=ENDINGS)
@pytest.mark.parametrize(("place", "bits"), [(0, 0xFF), (500, 1), (999, 0x80)])
def test_one_flipped_byte_or_bit_in_any_file_is_found_and_only_its_file_is_named(
    files: list[Path], flipped: int, place: int, bits: int
) -> None:
    content = bytearray(files[flipped].read_bytes())
    content[place] ^= bits
    files[flipped].write_bytes(content)
    (fault,) = differences(files[0].parent / "MANIFEST.sha256")
    assert fault.startswith(f"{files[flipped]}: hash ")


def test_order_of_files_does_not_matter(files: list[Path]) -> None:
    listed = files[0].parent / "MANIFEST.sha256"
    before = listed.read_bytes()
    write_lists([*reversed(files[:-1]), files[0]], files[-1:], listed)
    assert listed.read_bytes() == before


def test_a_missing_file_is_named(files: list[Path], tmp_path: Path) -> None:
    files[0].unlink()
    assert differences(tmp_path / "MANIFEST.sha256") == [f"{files[0]}: file is missing"]
    with pytest.raises(DataError, match=r"result\.parquet: file is missing"):
        write_lists(files, [], tmp_path / "NEW.sha256")
    assert not (tmp_path / "NEW.sha256").exists()
    with pytest.raises(DataError, match=r"NEW\.sha256: file is missing; \./reproduce all writes it"):
        differences(tmp_path / "NEW.sha256")


def test_equal_results_have_equal_manifests_whatever_time_they_took(files: list[Path]) -> None:
    listed = files[0].parent / "MANIFEST.sha256"
    before, times = listed.read_bytes(), listed.with_name(TIMES).read_bytes()
    files[-1].write_text("another time")
    assert len(differences(listed)) == 1
    write_lists(files[:-1], files[-1:], listed)
    assert listed.read_bytes() == before
    assert listed.with_name(TIMES).read_bytes() != times


def test_files_that_are_too_many_are_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    names = ["results/smoke/scores/a.csv", "tables/smoke/t.csv", "paper/build.json"]
    extra = ["results/smoke/robot_1/networks/b", "results/smoke/scores/b.csv", "tables/smoke/u.csv"]
    others = [
        "results/smoke/logs/a.log",
        "results/smoke/state/a",
        "results/smoke/robot_1/state/a",
        "results/default/a",
        "tables/v.csv",
        "paper/main.tex",
    ]
    for name in (*names, *extra, *others):
        write_text(Path(name), name)
    write_lists(map(Path, names), [], Path("results/smoke/MANIFEST.sha256"))
    found = differences(Path("results/smoke/MANIFEST.sha256"))
    assert [line.split(":")[0] for line in found] == extra


def test_a_damaged_list_is_named_with_its_line(files: list[Path]) -> None:
    listed = files[0].parent / "MANIFEST.sha256"
    listed.write_text(listed.read_text().replace("  ", " ", 2).replace(" ", "  ", 1))
    with pytest.raises(
        DataError, match=r"MANIFEST\.sha256:2: .* is not accepted; accepted: SHA-256, two spaces, a file"
    ):
        differences(listed)


def test_a_run_lists_all_of_its_results_and_nothing_of_other_scales(tmp_path: Path) -> None:
    """What equal runs differ in has a list of its own; logs, states, trials and Snakemake's own files have none."""
    results = tmp_path / "results/smoke"
    listed = ["results/smoke/plant/networks/a/run.json", "tables/smoke/a.csv", "results/smoke/paper/build.json"]
    timed = ["results/smoke/runs.html", "results/smoke/compute.csv"]
    left = [
        "results/smoke/logs/a.json", "results/smoke/plant/state/a/checkpoint", "results/smoke/trials/a.csv",
        "results/smoke/plant/recordings/a/b/.snakemake_timestamp", "tables/smoke/other/a.csv",
    ]  # fmt: skip
    for name in (*listed, *timed, *left):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(name)
    out = results / "MANIFEST.sha256"
    manifest(results, [tmp_path / "tables/smoke"], [results / "paper/build.json"], out)
    found = [
        sorted(str(Path(line.split("  ")[1]).relative_to(tmp_path)) for line in path.read_text().splitlines())
        for path in (out, results / TIMES)
    ]
    assert found == [sorted(listed), sorted(timed)]

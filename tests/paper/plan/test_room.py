"""Before a run: places that cannot be files or folders, and disks without room, are named."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any, NamedTuple

import pytest

from experiments.plan.plan import make_plan
from experiments.plan.room import RESOURCE, Sizes, check_room
from experiments.settings.load import load_settings
from mobnet.core.errors import DataError

SET = "results/smoke/plant/recordings/forward_walk/ideal"


class Usage(NamedTuple):
    """What shutil.disk_usage returns."""

    total: int
    used: int
    free: int


@pytest.fixture(scope="module")
def sizes() -> Sizes:
    plan = make_plan(load_settings(overrides={"scale": "smoke"}), with_pdf=False)
    return Sizes(plan.jobs)


def job(*outputs: str, size_mb: int | None = None) -> Any:
    """Return a job of Snakemake that makes files or folders of a size [MB]."""
    return SimpleNamespace(output=outputs, resources={} if size_mb is None else {RESOURCE: size_mb})


def test_a_file_in_place_of_a_folder_is_named(tmp_path: Path) -> None:
    check_room([job(str(tmp_path / SET))])
    (tmp_path / "results").touch()
    with pytest.raises(DataError, match=r"results: a file stands where the run writes a folder; move it away"):
        check_room([job(str(tmp_path / SET))])


def test_a_set_takes_its_rows_by_its_columns(sizes: Sizes) -> None:
    """Ten seconds at 1 kHz of some 280 columns of four bytes."""
    ideal = SimpleNamespace(robot="plant", scenario="forward_walk", level="ideal")
    assert 5 < sizes.recordings(ideal) < 10
    assert 1 < sizes.residuals(ideal) < sizes.recordings(ideal)


def test_estimates_take_the_joints_of_their_test(sizes: Sizes) -> None:
    """Of a test of all limbs 39 columns, of one of a leg's joint six; with networks as many again, for each seed."""
    whole = SimpleNamespace(robot="plant", scenario="motion_test", level="all_uncertainty")
    leg = SimpleNamespace(robot="plant", scenario="hip_pitch_step", level="all_uncertainty")
    assert sizes.estimates(whole) > sizes.estimates(leg) > 0


def test_too_little_room_is_told_with_what_is_needed_and_free(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    large = [job(str(tmp_path / SET), size_mb=7), job(str(tmp_path / "tables/smoke/table_05.csv"))]
    check_room(large)
    monkeypatch.setattr("shutil.disk_usage", lambda _: Usage(10, 5, 1_000_000))
    with pytest.raises(DataError, match=r"too little space .*; needed: 8 MB, free: 1 MB"):
        check_room(large)
    check_room(large[1:])

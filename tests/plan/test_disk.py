"""Before a run: places that cannot be files or folders, and disks without room, are named."""

import shutil
from pathlib import Path
from typing import NamedTuple

import pytest

from experiments.plan.disk import check_places, check_space, expected_bytes
from experiments.plan.plan import Plan, make_plan
from experiments.settings.load import load_settings
from mobnet.core.errors import DataError

ARRAY = "results/smoke/recordings/forward_walk/ideal/s101.parquet"


class Usage(NamedTuple):
    """What shutil.disk_usage returns."""

    total: int
    used: int
    free: int


@pytest.fixture(scope="module")
def plan() -> Plan:
    return make_plan(load_settings(overrides={"scale": "smoke"}), with_pdf=False)


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Work in an empty folder."""
    monkeypatch.chdir(tmp_path)


def test_a_folder_in_place_of_a_file_and_a_file_in_place_of_a_folder_are_named(plan: Plan) -> None:
    check_places(plan)
    Path(ARRAY).mkdir(parents=True)
    with pytest.raises(DataError, match=rf"^{ARRAY}: a folder is not accepted; accepted: a file"):
        check_places(plan)
    shutil.rmtree("results")
    Path("results").touch()
    with pytest.raises(DataError, match=r"^results: a file is not accepted; accepted: a folder"):
        check_places(plan)


def test_an_array_takes_its_rows_by_its_columns(plan: Plan) -> None:
    """Ten seconds at 1 kHz of some 280 columns of four bytes."""
    assert 5_000_000 < expected_bytes(plan, Path(ARRAY)) < 10_000_000
    assert expected_bytes(plan, Path("tables/smoke/table_05.csv")) < 1_000_000


def test_an_estimate_takes_the_joints_that_it_holds(plan: Plan) -> None:
    """Six joints of a leg with their standard deviations, 33 of all limbs with theirs, and 39 of a method without.

    Where a test is about both legs, it takes their twelve alone.
    """
    names = ("MOB-Net-plain", "MOB-Net", "MOB")
    sizes = [
        expected_bytes(plan, Path(f"results/smoke/estimates/{name}/n0/walk_test/ideal/s101.parquet")) for name in names
    ]
    assert sizes[1] > sizes[2] > sizes[0]
    assert sizes[2] / sizes[0] == pytest.approx(39 / 12, rel=1e-3)
    legs = Path("results/smoke/robot_1/estimates/MOB/n0/walk_test/robot_1/s101.parquet")
    assert expected_bytes(plan, legs) == pytest.approx(sizes[0], rel=1e-3)


def test_too_little_room_is_told_with_what_is_needed_and_free(plan: Plan, monkeypatch: pytest.MonkeyPatch) -> None:
    check_space(plan, [ARRAY])
    monkeypatch.setattr("shutil.disk_usage", lambda _: Usage(10, 5, 2**20))
    with pytest.raises(DataError, match=r"too little space .*; needed: [5-9] MiB, free: 1 MiB"):
        check_space(plan, [ARRAY])
    check_space(plan, ["tables/smoke/table_05.csv"])

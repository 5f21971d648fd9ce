"""Sheets say what the rules read, and `./reproduce sheet` prints them."""

from pathlib import Path

import pytest

from experiments import sheet
from experiments.plan.plan import Plan, make_plan
from experiments.plan.product import Folders
from experiments.plan.sheets import Own, Sheets, columns, seeds_in
from experiments.running.words import SHEETS, sheet_parser
from experiments.settings.load import load_settings
from mobnet.core.errors import ConfigError


@pytest.fixture(scope="module")
def plan() -> Plan:
    return make_plan(load_settings(overrides={"scale": "smoke"}), with_pdf=False)


def test_every_row_of_every_sheet_can_be_told(plan: Plan) -> None:
    sheets = Sheets(plan).all
    assert list(sheets) == list(SHEETS)
    for name, own in sheets.items():
        rows = [sheet.told(row, own[row]) for row in own]
        assert len(rows) == len(own) > 0 or name == "stacks"


def test_a_network_has_what_it_learns_from(plan: Plan) -> None:
    networks = Sheets(plan).networks
    plain, gray = networks["robot_1/MOB-Net-LL-s101"], networks["plant/MOB-Net-gray-LL-s0"]
    assert plain["recordings"] == plain["residuals"] == [Own("robot_1", "robot_walk/robot_1")]
    assert len(plain["seeds"]) == 1
    assert plain["networks"] == plain["fits"] == plain["stacks"] == []
    assert gray["fits"] == [Own("plant", "MOB-fric-load")]
    assert networks["robot_1/MOB-Net-LL-s101"] is plain  # a row is worked out once


def test_a_network_that_is_fine_tuned_has_the_one_that_it_begins_with(plan: Plan) -> None:
    tuned = next(row for name, row in Sheets(plan).networks.items() if "swing-data" in name)
    assert [str(own) for own in tuned["networks"]] == ["robot_1/MOB-Net-LL-s101"]


def test_a_file_has_one_column() -> None:
    results = Path("results/smoke")
    folders = Folders(results, Path("tables/smoke"), Path("figures/smoke"), results / "paper", results / "list")
    found = columns(
        [
            "results/smoke/robot_1/estimates/walk/a", "results/smoke/robot_1/networks/A-LL-s0/weights.safetensors",
            "results/smoke/robot_1/networks/A-LL-s0/run.json", "results/smoke/scores/walk/a.csv",
            "results/smoke/robot_1/reactions/knee.csv", "results/smoke/robot_1/reactions/knee.parquet",
            "results/smoke/robot_1/falls.csv", "tables/smoke/claims.csv", "tables/smoke/claims.md", "paper/main.tex",
        ],
        folders,
    )  # fmt: skip
    assert {column: list(map(str, names)) for column, names in found.items() if names} == {
        "estimates": ["robot_1/walk/a"], "networks": ["robot_1/A-LL-s0"], "scores": ["walk/a"],
        "reactions": ["robot_1/knee"], "courses": ["robot_1/knee"], "falls": ["robot_1"], "tables": ["claims"],
        "files": ["tables/smoke/claims.md", "paper/main.tex"],
    }  # fmt: skip


def test_seeds_stand_set_by_set() -> None:
    recordings = [Path("a/recordings/s1"), Path("a/recordings/s2"), Path("b/recordings/s1")]
    assert seeds_in(recordings) == [[1, 2], [1]]


def printed(*words: str) -> str:
    """Return what the command prints."""
    return "\n".join(sheet.run(sheet_parser().parse_args(words)))


def test_a_row_is_printed() -> None:
    assert printed("shown", "table_07", "--config", "scale=smoke") == "table_07\n    scores      walk_test/robots"


@pytest.mark.parametrize(("words", "line"), [
    (("show",), "sheet: 'show' is not accepted; accepted: .*shown"),
    (("shown", "table_77"), "row of shown: 'table_77' is not accepted; accepted: table_"),
])  # fmt: skip
def test_a_wrong_word_is_one_line(words: tuple[str, ...], line: str) -> None:
    with pytest.raises(ConfigError, match=line):
        printed(*words)

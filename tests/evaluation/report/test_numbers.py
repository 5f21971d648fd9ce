"""Numbers of the prose are those of the tables."""

import csv
import re
from pathlib import Path

import pytest

from mobnet.core.columns import VERDICTS
from mobnet.evaluation.report.numbers import numbers, size_texts
from mobnet.settings.data import Recordings
from mobnet.settings.settings import Settings

REPO = Path(__file__).parents[3]
TABLE_05 = REPO / "tests/golden/table_05.csv"
TRAIN = Recordings(shards=3, shard_s=600.0)
ASKED = {  # command of the paper's text -> name of its number
    "ours": "ours@forward_walk@{}@{}@{}@rmse",
    "published": "published@forward_walk@{}@{}@{}@rmse",
    "foundspan": "span@{}",
    "scored": "scored@{}@{}",
    **{name: f"{name}@{{}}" for name in ("claimed", "found", "verdict", "cause", "size")},
}


def defined(table: Path, claims_csv: Path, summary_csv: Path, settings: Settings) -> dict[str, str]:
    """Return name -> text of the numbers of a table and of claims."""
    out = claims_csv.with_name("numbers.tex")
    numbers(
        settings.scale, settings.rates, settings.sizes, settings.fleet, TRAIN, [table], claims_csv, summary_csv, out
    )
    return dict(re.findall(r"\\csname ([^\\]+)\\endcsname\{(.*)\}\n", out.read_text()))


@pytest.fixture
def texts(claims_csv: Path, summary_csv: Path, settings: Settings) -> dict[str, str]:
    """Name -> text of the numbers of the golden Table 5 and of made-up claims."""
    return defined(TABLE_05, claims_csv, summary_csv, settings)


def test_every_cell_and_claim_has_its_number(texts: dict[str, str], claims_csv: Path) -> None:
    for cell in csv.DictReader(TABLE_05.read_text().splitlines()):
        where = f"forward_walk@{cell['level']}@{cell['method']}@{cell['joint']}@{cell['metric']}"
        assert texts[f"ours@{where}"] == f"{float(cell['value']):.2f}"
    for claim in csv.DictReader(claims_csv.read_text().splitlines()):
        told = [texts[f"{name}@{claim['claim']}"] for name in ("verdict", "found", "span")]
        assert told == [claim["verdict"], "1.00", "[0.90, 1.10]"]
        assert f"cause@{claim['claim']}" in texts


def test_a_mean_over_metrics_has_a_short_name_and_a_missing_number_a_dash(
    claims_csv: Path, summary_csv: Path, settings: Settings
) -> None:
    table = claims_csv.with_name("knee.csv")
    header = TABLE_05.read_text().splitlines()[0]
    table.write_text(f"{header}\nknee,all,MOB,avg,rmse_push_1+rmse_push_2,,,,1,1,,,N m,3.5\n")
    texts = defined(table, claims_csv, summary_csv, settings)
    assert (texts["ours@knee@all@MOB@avg@mean"], texts["published@knee@all@MOB@avg@mean"]) == ("-", "3.50")


def test_verdicts_add_up(texts: dict[str, str], settings: Settings) -> None:
    counts = [int(texts[f"scored@all@{name}"]) for name in VERDICTS]
    assert min(counts) > 0
    assert sum(counts) == int(texts["scored@all@all"]) == len(settings.claims)


def test_every_number_the_paper_asks_for_exists(texts: dict[str, str]) -> None:
    main = " ".join((REPO / "paper/main.tex").read_text().split())
    commands = re.findall(r"\\(\w+)((?:\{[^{}]*\})+)", main)
    asked = [ASKED[name].format(*rest[1:-1].split("}{")) for name, rest in commands if name in ASKED]
    assert len(asked) > 20
    assert [name for name in asked if name not in texts] == []


def test_sizes_are_those_of_the_scale(settings: Settings) -> None:
    found = size_texts("default", settings.rates, settings.sizes, settings.fleet, TRAIN)
    assert (found["train minutes"], found["train samples"], found["scale"]) == ("30", "1.8", "default")
    assert (found["robots"], found["robot test runs"]) == ("3", "6")
    assert found["network runs"] == str(len(settings.sizes.experiments["left_leg"].seeds))

"""Numbers of the prose are those of the tables."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from mobnet.evaluation.number.claim import read_claims
from mobnet.evaluation.number.rows import Cell, read_rows
from mobnet.evaluation.report.numbers import cell_texts, numbers, size_texts
from mobnet.evaluation.tables.claims import VERDICTS, Verdict, claims
from mobnet.evaluation.tables.errors import table

REPO = Path(__file__).parents[3]


CLAIMS = REPO / "configs/claims.yaml"
MEANS = {"MOB": 19.0, "MOB-fric": 15.0, "MOB-Net": 1.5, "FTS-e2e": 2.0, "MOB-Net-plain": 2.5}
MEANS |= {"MOB-Net-Single": 2.0, "MOB-Net-Single-2X": 2.1}


@pytest.fixture
def tex(tmp_path: Path, config: dict[str, Any], scores_csv: Path, write_results: Callable[..., Any]) -> str:
    """Macros of the made-up results."""
    table(config, "table_05", {"forward_walk": scores_csv}, tmp_path)
    claims(config, CLAIMS, *write_results(read_claims(CLAIMS), MEANS), tmp_path)
    numbers(config, [tmp_path / "table_05.csv"], tmp_path / "claims.csv", tmp_path / "numbers.tex")
    return (tmp_path / "numbers.tex").read_text()


def test_every_cell_and_claim_has_its_number(tex: str, tmp_path: Path) -> None:
    for cell in read_rows(tmp_path / "table_05.csv", Cell):
        where = f"forward_walk@{cell.level}@{cell.method}@{cell.joint}@rmse"
        assert rf"\csname ours@{where}\endcsname{{{cell.value:.2f}}}" in tex
    for row in read_rows(tmp_path / "claims.csv", Verdict):
        assert rf"\csname verdict@{row.claim}\endcsname{{{row.verdict}}}" in tex
        assert rf"\csname cause@{row.claim}\endcsname{{" in tex


def test_a_mean_over_metrics_has_a_short_name_and_a_missing_number_a_dash() -> None:
    cell = Cell("knee", "all", "MOB", "avg", 0, "rmse_push_1+rmse_push_2", None, None, None, "N m", 3.5)
    where = "knee@all@MOB@avg@mean"
    assert cell_texts(cell) == {f"ours@{where}": "-", f"published@{where}": "3.50"}


def test_verdicts_add_up(tex: str) -> None:
    counts = {}
    for name in (*VERDICTS, "claims"):
        counts[name] = int(tex.split(rf"\csname size@{name}\endcsname{{")[1].split("}")[0])
    assert sum(counts.values()) == 2 * counts["claims"]


def test_every_number_the_paper_asks_for_exists(tex: str) -> None:
    words = (REPO / "paper/main.tex").read_text().replace("\n", " ").split("\\")
    asked = []
    for word in words:
        name, _, rest = word.partition("{")
        parts = [part.split("}")[0] for part in rest.split("{")]
        if name in ("ours", "published"):
            asked.append("@".join([name, "forward_walk", *parts[:3], "rmse"]))
        elif name in ("claimed", "found", "foundspan", "verdict", "cause", "size"):
            asked.append(f"{name.removeprefix('found') if name == 'foundspan' else name}@{parts[0]}")
    assert len(asked) > 20
    assert [name for name in asked if rf"\csname {name}\endcsname" not in tex] == []


def test_sizes_are_those_of_the_scale(config: dict[str, Any]) -> None:
    sizes = size_texts(config)
    assert (sizes["train minutes"], sizes["train samples"], sizes["network runs"]) == ("30", "1.8", "3")

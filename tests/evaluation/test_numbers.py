"""Numbers of the prose are those of the tables."""

from pathlib import Path
from typing import Any

import pytest

from mobnet.evaluation.claims import Verdict, claims
from mobnet.evaluation.numbers import numbers, size_texts
from mobnet.evaluation.rows import Cell, read_rows
from mobnet.evaluation.tables import table

REPO = Path(__file__).parents[2]


@pytest.fixture
def tex(tmp_path: Path, config: dict[str, Any], scores_csv: Path) -> str:
    """Macros of the made-up results."""
    table(config, "table_05", {"forward_walk": scores_csv}, tmp_path)
    claims(config, REPO / "configs/claims.yaml", scores_csv, tmp_path)
    numbers(config, tmp_path / "table_05.csv", tmp_path / "claims.csv", tmp_path / "numbers.tex")
    return (tmp_path / "numbers.tex").read_text()


def test_every_cell_and_claim_has_its_number(tex: str, tmp_path: Path) -> None:
    for cell in read_rows(tmp_path / "table_05.csv", Cell):
        assert rf"\csname ours@{cell.level}@{cell.method}@{cell.joint}\endcsname{{{cell.value:.2f}}}" in tex
    for row in read_rows(tmp_path / "claims.csv", Verdict):
        assert rf"\csname verdict@{row.claim}\endcsname{{{row.verdict}}}" in tex


def test_verdicts_add_up(tex: str) -> None:
    counts = {}
    for name in ("reproduced", "direction only", "not reproduced", "claims"):
        counts[name] = int(tex.split(rf"\csname size@{name}\endcsname{{")[1].split("}")[0])
    assert sum(counts.values()) == 2 * counts["claims"]


def test_every_number_the_paper_asks_for_exists(tex: str) -> None:
    words = (REPO / "paper/main.tex").read_text().replace("\n", " ").split("\\")
    asked = []
    for word in words:
        name, _, rest = word.partition("{")
        if name in ("ours", "published", "claimed", "found", "verdict", "size"):
            parts = [part.split("}")[0] for part in rest.split("{")]
            asked.append("@".join([name, *parts[: 3 if name in ("ours", "published") else 1]]))
    assert len(asked) > 20
    assert [name for name in asked if rf"\csname {name}\endcsname" not in tex] == []


def test_sizes_are_those_of_the_scale(config: dict[str, Any]) -> None:
    sizes = size_texts(config)
    assert (sizes["train minutes"], sizes["train samples"], sizes["network runs"]) == ("30", "1.8", "3")

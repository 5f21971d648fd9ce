"""Kinds of networks stand in the order of their loss by each recipe, beside the paper's; what diverged says so."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from csv_files import check_golden, read_table

from experiments.settings.evaluation import Evaluation

LOSSES = {"LSTM": -5.0, "GRU": -4.5, "TCN": -4.0, "MLP-500": -3.9, "MLP": -3.5, "RNN": -3.0}
BEST = {"GRU": -6.0, "LSTM": -5.5, "MLP-500": -4.4, "TCN": -4.2, "MLP": -3.7, "RNN": -3.6}
Write = Callable[..., Path]


@pytest.fixture
def traits(make_table: Write, write_training: Write) -> dict[tuple[str, str], Any]:
    """The table of made-up kinds, LSTM best by one recipe, GRU by its own; the printed rate diverges once of twice."""
    common = {f"{kind}-adam": loss for kind, loss in LOSSES.items()}
    folders = [write_training(kind, seed, loss + 0.1 * seed) for kind, loss in common.items() for seed in range(5)]
    folders += [write_training(kind, 0, loss) for kind, loss in BEST.items()]
    folders += [write_training("windows", 0, -9.0)]
    folders += [write_training("printed-rate", seed, epochs=2, diverged=seed == 1) for seed in range(2)]
    table = make_table("kinds", folders=folders)
    check_golden(table)
    return {(row.method, row.quantity): row for row in read_table(table)}


def test_order_is_by_validation_loss_among_the_kinds_that_the_paper_orders(traits: dict[Any, Any]) -> None:
    order = {method: trait.value for (method, quantity), trait in traits.items() if quantity == "order"}
    assert list(order) == [*(f"{kind}-adam" for kind in LOSSES), *BEST, "windows", "printed-rate"]
    assert order == {
        "LSTM-adam": 1, "GRU-adam": 2, "TCN-adam": 3, "MLP-500-adam": None, "MLP-adam": 4, "RNN-adam": 5,
        "GRU": 1, "LSTM": 2, "MLP-500": None, "TCN": 3, "MLP": 4, "RNN": 5, "windows": None, "printed-rate": None,
    }  # fmt: skip
    printed = {"GRU": 1, "LSTM": 2, "TCN": 3, "RNN": 4, "MLP": 5, "MLP-500": None}
    assert {kind: traits[kind, "order"].published for kind in BEST} == printed
    assert {kind: traits[f"{kind}-adam", "order"].published for kind in BEST} == printed


def test_each_recipe_and_our_variants_are_a_part_of_their_own(traits: dict[Any, Any], tmp_path: Path) -> None:
    assert traits["GRU", "runs"].value == 1
    tex = (tmp_path / "kinds.tex").read_text()
    assert tex.index("RNN-adam") < tex.index("midrule", tex.index("RNN-adam")) < tex.index("& GRU &")
    assert tex.index("& RNN &") < tex.index("midrule", tex.index("& RNN &")) < tex.index("& windows &")


def test_numbers_are_means_over_runs_inside_their_intervals(traits: dict[Any, Any], tmp_path: Path) -> None:
    loss = traits["GRU-adam", "validation loss"]
    assert loss.value == pytest.approx(-4.3)
    assert -4.5 <= loss.low < -4.3 < loss.high <= -4.1
    assert traits["GRU-adam", "validation loss at the end"].value == pytest.approx(-3.8)
    assert traits["GRU-adam", "training loss at the end"].value == pytest.approx(-4.05)
    assert traits["GRU-adam", "validation RMSE"].value == pytest.approx(5.7)
    assert traits["GRU-adam", "validation loss on windows"].value == pytest.approx(-4.175)
    assert traits["MLP-500-adam", "parameters"].published == 756512
    # runs that diverged are counted and left out
    assert (traits["printed-rate", "runs"].value, traits["printed-rate", "diverged"].value) == (2, 1)
    assert traits["printed-rate", "validation loss"].value == pytest.approx(-4.0)
    assert "| 2, 1 diverged |" in (tmp_path / "kinds.md").read_text()


def test_a_kind_that_always_diverged_comes_last_without_numbers(
    evaluation: Evaluation, make_table: Write, write_training: Write
) -> None:
    table = make_table(
        "kinds", settings=evaluation.kinds.model_copy(update={"variants": ()}),
        figure_17=evaluation.figure_17.model_copy(update={"methods": ("RNN-adam", "GRU-adam"), "best": ("RNN", "GRU")}),
        folders=[write_training("RNN-adam", epochs=0, diverged=True), write_training("GRU-adam"),
                 write_training("RNN", epochs=0, diverged=True), write_training("GRU")],
    )  # fmt: skip
    rows = read_table(table)
    assert list(dict.fromkeys(row.method for row in rows)) == ["GRU-adam", "RNN-adam", "GRU", "RNN"]
    assert {row.value for row in rows if row.method.startswith("RNN") and row.unit != "-"} == {None}
    assert "95%" not in table.with_suffix(".md").read_text()  # a single run has no interval

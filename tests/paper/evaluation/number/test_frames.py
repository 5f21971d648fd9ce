"""Frames: columns as their schema says, groups of which nothing is found, and orders that a concatenation keeps."""

from collections.abc import Callable
from dataclasses import fields
from pathlib import Path

import pandas as pd
import pytest
from csv_files import write_rows

from experiments.evaluation.number.frames import DETECTION, SCORES, ordered, read_scores
from experiments.evaluation.number.laws import measured
from experiments.evaluation.number.number import Number
from experiments.records.collisions import FILES, columns_of
from experiments.records.scores import Score
from mobnet.core.errors import DataError

Scores = Callable[..., list[Score]]


def test_a_schema_has_the_columns_of_its_file() -> None:
    assert list(SCORES) == [field.name for field in fields(Score)]
    assert {name: tuple(schema) for name, schema in DETECTION.items()} == {name: columns_of(name) for name in FILES}


def test_scores_are_read_as_their_schema_says_also_none_of_them(tmp_path: Path, make_scores: Scores) -> None:
    for name, rows in (("some", make_scores()), ("none", [])):
        write_rows(tmp_path / name, rows)
        frame = read_scores(tmp_path / name)
        assert len(frame) == len(rows)
        assert {column: str(kind) for column, kind in frame.dtypes.items()} == {
            column: kind for column, (kind, _, _) in SCORES.items()
        }


def test_a_row_that_is_not_accepted_is_refused_in_one_line(tmp_path: Path, make_scores: Scores) -> None:
    write_rows(tmp_path / "scores.csv", make_scores())
    text = (tmp_path / "scores.csv").read_text().replace(",MOB-Net,0,", ",MOB-Net,-1,", 1)
    (tmp_path / "scores.csv").write_text(text)
    with pytest.raises(
        DataError, match=r"scores.csv:\d+: network_seed: -1 is not accepted; accepted: 0 or more"
    ) as error:
        read_scores(tmp_path / "scores.csv")
    assert len(str(error.value).splitlines()) == 1


def rows() -> pd.DataFrame:
    """Return what two detectors find of three hits: the first one something, the second one nothing."""
    names = ["B", "B", "B", "A", "A", "A"]
    return pd.DataFrame({"detector": names, "found": [True, False, True, False, False, False]})


def count(own: pd.DataFrame) -> Number:
    """Return how many rows there are."""
    return Number(len(own))


def test_a_group_of_which_nothing_is_found_keeps_its_row() -> None:
    table = measured(ordered(rows(), detector=["B", "A"]), ["detector"], {"found": count}, of="found")
    assert table[["detector", "value", "count"]].to_numpy().tolist() == [["B", 2, 2], ["A", 0, 0]]


def test_groups_stand_in_the_order_given_and_what_it_lacks_is_left_out() -> None:
    for order in (["B", "A"], ["A", "B"], ["A"]):
        assert list(measured(ordered(rows(), detector=order), ["detector"], {"all": count})["detector"]) == order


def test_every_group_has_each_value_of_a_further_column() -> None:
    hits = ordered(rows().assign(cell=["x", "x", "y", "x", "x", "x"]), detector=["B", "A"], cell=["y", "x"])
    table = measured(hits, ["detector"], {"all": count}, each="cell")
    assert table[["detector", "cell", "value"]].to_numpy().tolist() == [
        ["B", "y", 1], ["B", "x", 2], ["A", "y", 0], ["A", "x", 3],
    ]  # fmt: skip


def test_the_order_of_groups_outlives_a_concatenation_of_parts_with_the_same_values() -> None:
    hits = ordered(rows(), detector=["B", "A", "all"])
    every = hits.assign(detector=pd.Categorical(["all"] * len(hits), hits["detector"].cat.categories))
    both = pd.concat([hits, every])
    assert list(measured(both, ["detector"], {"all": count})["detector"]) == ["B", "A", "all"]

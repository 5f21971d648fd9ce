"""The figures of claims: each statement once by its worst claim, over the paper or beyond its bound; texts fit."""

import csv
from collections import Counter
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import pandas as pd
import pytest

from experiments.evaluation.figures.further.forest import ENDS, LOOKS, draw_forest, forest, text_of
from experiments.evaluation.measure.claims.places import (
    BEYOND_BOUND,
    OVER_PAPER,
    margin,
    over_paper,
    position_of,
    statements_of,
)
from experiments.evaluation.measure.claims.verdicts import ClaimNumbers, claims_frame, rows_of, score_of, worst
from experiments.evaluation.measure.claims.verdicts import judged as judged_on
from experiments.evaluation.number.frames import rows_of as frame_rows
from experiments.evaluation.number.number import Number
from experiments.settings.settings import Settings
from experiments.settings.table_columns import FOREST
from experiments.settings.verdicts import NO_NUMBER, OURS, VERDICTS

LONGEST_LABEL = 64  # characters of what a claim says


def judged(settings: Settings, name: str, ours: Number) -> dict[str, Any]:
    """Return a claim of the configuration, judged on a number."""
    row = next(row for row in rows_of(settings.claims) if row.name == name)
    return judged_on(
        row, ClaimNumbers(ours, ours), score_of(row.claim, settings.methods), settings.evaluation.statistics
    )


def test_a_number_is_over_that_of_the_paper(settings: Settings) -> None:
    place = position_of(judged(settings, "noise-floor", Number(2.44, 1.22, 4.88, published=1.22)))
    assert place.pop("axis") == OVER_PAPER
    assert tuple(place.values()) == pytest.approx((2.0, 1.0, 4.0, 0.8, 1.25))


def test_of_a_cut_what_remains_is_over_what_remains_in_the_paper(settings: Settings) -> None:
    """A closed form: 0.068 of the error remain in the paper, 0.136 and its ends here."""
    published = settings.claims["mob-net-cut"].published
    ours = Number(1 - 0.136, 1 - 0.272, 1 - 0.068, published=published)
    *values, first, last = over_paper(judged(settings, "mob-net-cut", ours)).values()
    assert values == pytest.approx([2.0, 1.0, 4.0])
    assert 0.0 < (first or 0.0) < 1.0 < (last or 0.0)


@pytest.mark.parametrize(
    ("name", "ours", "values"),
    [
        ("swing-best", Number(0.5, 0.25, 1.0), (0.5, 0.25, 1.0)),
        ("swing-best", Number(-0.5, -1.0, 0.25), (-0.5, -1.0, 0.25)),
        ("rnn-like-mlp", Number(0.125, 0.0, 0.375), (0.5, -0.5, 1.0)),
        ("double-motion", Number(1.0, 0.95, 1.05), (1.0, 0.5, 1.0)),
        ("swing-best", Number(None), (None, None, None)),
    ],
)
def test_without_a_number_of_the_paper_the_claimed_side_is_on_the_right(
    name: str, ours: Number, values: tuple[float | None, ...], settings: Settings
) -> None:
    place = position_of(judged(settings, name, ours))
    assert place.pop("axis") == BEYOND_BOUND
    assert tuple(place.values()) == pytest.approx((*values, 0.0, None))


@pytest.mark.parametrize(
    ("number", "bounds", "inside"),
    [
        (0.3, (0.0, 1.0), 0.3),
        (0.8, (0.0, 1.0), 0.2),
        (1.5, (0.0, 1.0), -0.5),
        (-0.5, (0.0, 1.0), -0.5),
        (0.8, (0.5, None), 0.3),
        (0.8, (None, 1.5), 0.7),
    ],
)
def test_a_number_lies_as_far_inside_a_range_as_the_nearer_end_says(
    number: float, bounds: tuple[float | None, float | None], inside: float
) -> None:
    assert margin(number, bounds) == pytest.approx(inside)


def all_judged(settings: Settings) -> pd.DataFrame:
    """Return all claims of the configuration, judged on made-up numbers."""
    made = (Number(1.0, 0.9, 1.1), Number(30.0, 29.0, 31.0), Number(-0.5, -0.6, -0.4), Number(None))
    rows: list[dict[str, Any]] = []
    for k, row in enumerate(rows_of(settings.claims)):
        rows.append(judged(settings, row.name, replace(made[k % len(made)], published=row.claim.published)))
    return claims_frame(rows)


def test_a_statement_has_the_verdict_of_its_worst_claim_and_counts_against_us_first(settings: Settings) -> None:
    every = all_judged(settings)
    statements = statements_of(every)
    by_statement = every.groupby("statement")["verdict"].agg(list)
    verdicts = statements.set_index("statement")["verdict"]
    assert verdicts.to_dict() == {name: worst(verdicts) for name, verdicts in by_statement.items()}
    counts = statements.set_index("statement")["claims"]
    assert counts.to_dict() == by_statement.map(len).to_dict()
    for _, of_score in statements.groupby("score"):
        order = [VERDICTS.index(verdict) for verdict in of_score["verdict"]]
        assert order == sorted(order)
        assert len(set(order)) > 1


def test_every_statement_is_in_one_of_the_two_figures(settings: Settings, tmp_path: Path) -> None:
    every = all_judged(settings)
    forest(every, 0.95, tmp_path)
    found = {}
    for stem in ("claims", "claims_own"):
        rows = list(csv.DictReader((tmp_path / f"{stem}.csv").read_text().splitlines()))
        assert tuple(rows[0]) == FOREST
        assert {path.suffix for path in tmp_path.glob(f"{stem}.*")} == {".csv", ".pdf", ".svg", ".png"}
        found[stem] = Counter(row["statement"] for row in rows)
        assert {row["score"] in (NO_NUMBER, OURS) for row in rows} == {stem == "claims_own"}
    assert found["claims"] + found["claims_own"] == Counter(set(every["statement"]))


def of(settings: Settings, values: tuple[float | None, ...], name: str = "noise-floor") -> pd.DataFrame:
    """Return a statement with a number that lies at some places of the axis."""
    number = Number(*(None if value is None else 1.22 * value for value in values), published=1.22)
    return statements_of(claims_frame([judged(settings, name, number)]))


@pytest.mark.parametrize(
    ("values", "arrows"),
    [
        ((1.0, 0.9, 1.1), ""), ((0.01, 0.009, 0.011), "<"), ((99.0, 90.0, 110.0), ">"), ((1.0, 0.01, 1.1), "<"),
        ((1.0, 0.01, 99.0), "<>"), ((None, None, None), ""),
    ],
)  # fmt: skip
def test_what_lies_beyond_the_axis_is_an_arrow_at_its_end(
    values: tuple[float | None, ...], arrows: str, settings: Settings
) -> None:
    (axis,) = draw_forest(of(settings, values), OVER_PAPER, "95% interval").axes
    drawn = [line for line in axis.lines if line.get_marker() in ("<", ">")]
    assert "".join(str(line.get_marker()) for line in drawn) == arrows
    ends = {"<": ENDS[OVER_PAPER][0], ">": ENDS[OVER_PAPER][1]}
    assert all(line.get_xdata()[0] == ends[str(line.get_marker())] for line in drawn)  # type: ignore[index]
    if values[0] is None:
        assert "not measured" in [text.get_text() for text in axis.texts]


def test_texts_stand_beside_one_another_within_the_page_and_are_large_enough(settings: Settings) -> None:
    for name in (OVER_PAPER, BEYOND_BOUND):
        shown = frame_rows(statements_of(all_judged(settings)), axis=name)
        figure = draw_forest(shown, name, "95% interval")
        figure.draw_without_rendering()
        (axis,) = figure.axes
        rows: dict[float, list[Any]] = {}
        for text in axis.texts:
            assert text.get_fontsize() >= 6.0
            rows.setdefault(text.get_position()[1], []).append(text.get_window_extent())
        assert len(rows) >= len(shown)
        for boxes in rows.values():
            assert boxes[0].x0 >= 0.0
            assert boxes[-1].x1 <= figure.bbox.width
            assert all(one.x1 < other.x0 for one, other in pairwise(boxes))
        (key,) = figure.legends
        assert 0.0 <= key.get_window_extent().x0 < key.get_window_extent().x1 <= figure.bbox.width
        there = set(shown["verdict"])
        named = [text.get_text().split(" (")[0].split(" ", 1)[1] for text in key.get_texts()[:-1]]
        assert named == [verdict for verdict in LOOKS if verdict in there]
        left = axis.get_window_extent().x0
        says = [text for text in axis.texts if text.get_text() in set(map(text_of, shown.to_dict("records")))]
        assert len(says) == len(shown)
        assert [text.get_text() for text in says if text.get_window_extent().x1 > left] == []


def test_labels_fit_beside_their_rows(settings: Settings) -> None:
    assert [name for name, claim in settings.claims.items() if len(claim.says) > LONGEST_LABEL] == []

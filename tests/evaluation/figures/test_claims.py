"""The figure of claims: each once, over the paper or beyond its bound; statements are whole, labels fit."""

import csv
from pathlib import Path
from typing import Any

import pytest

from mobnet.core.columns import FOREST, VERDICTS
from mobnet.evaluation.figures.further.forest import (
    BEYOND_BOUND,
    OVER_PAPER,
    beyond_bound,
    columns_of,
    forest,
    over_paper,
)
from mobnet.evaluation.measure.claims.bounds import ranges_of
from mobnet.evaluation.measure.claims.verdicts import Judged, rows_of, score_of, verdict_of
from mobnet.evaluation.number.number import Number
from mobnet.settings.settings import Settings

LONGEST_LABEL = 64  # characters in a column of the page


def judged(settings: Settings, name: str, ours: Number, **changes: Any) -> Judged:
    """Return a claim of the configuration, judged on a number."""
    row = next(row for row in rows_of(settings.claims) if row.name == name)
    ranges = ranges_of(row.claim)
    score = score_of(row.claim, settings.methods)
    return Judged(row, changes.get("score", score), ours, ranges, verdict_of(ours, ranges), "")


def test_a_number_is_over_that_of_the_paper(settings: Settings) -> None:
    place = over_paper(judged(settings, "noise-floor", Number(2.44, 1.22, 4.88)))
    assert (place.axis, place.values) == (OVER_PAPER, pytest.approx((2.0, 1.0, 4.0)))
    assert place.band == pytest.approx((0.5, 2.0))


def test_of_a_cut_what_remains_is_over_what_remains_in_the_paper(settings: Settings) -> None:
    """A closed form: 0.068 of the error remain in the paper, 0.136 and its ends here."""
    place = over_paper(judged(settings, "mob-net-cut", Number(1 - 0.136, 1 - 0.272, 1 - 0.068)))
    assert place.values == pytest.approx((2.0, 1.0, 4.0))
    assert 0.0 < (place.band[0] or 0.0) < 1.0 < (place.band[1] or 0.0)


@pytest.mark.parametrize(
    ("name", "ours", "values"),
    [
        ("swing-best", Number(0.5, 0.25, 1.0), (0.5, 0.25, 1.0)),
        ("swing-best", Number(-0.5, -1.0, 0.25), (-0.5, -1.0, 0.25)),
        ("support-gap", Number(0.5, 0.0, 1.5), (0.5, -0.5, 1.0)),
        ("double-motion", Number(1.0, 0.95, 1.05), (1.0, 0.5, 1.0)),
        ("swing-best", Number(None), (None, None, None)),
    ],
)
def test_without_a_number_of_the_paper_the_claimed_side_is_on_the_right(
    name: str, ours: Number, values: tuple[float | None, ...], settings: Settings
) -> None:
    place = beyond_bound(judged(settings, name, ours))
    assert (place.axis, place.band) == (BEYOND_BOUND, (0.0, None))
    assert place.values == pytest.approx(values)


def test_every_claim_is_drawn_once_and_statements_stay_whole(settings: Settings, tmp_path: Path) -> None:
    all_judged = [judged(settings, row.name, Number(1.0, 0.9, 1.1)) for row in rows_of(settings.claims)]
    all_judged[0] = judged(settings, "mob-exact", Number(None))
    columns = columns_of([over_paper(each) for each in all_judged])
    drawn = [place.judged.row for column in columns for panel in column for place in panel]
    assert sorted(row.name for row in drawn) == sorted(each.row.name for each in all_judged)
    statements = [row.statement for row in drawn]
    assert len(dict.fromkeys(statements)) == sum(a != b for a, b in zip(statements, ["", *statements], strict=False))
    forest(all_judged, 0.95, tmp_path)
    rows = list(csv.DictReader((tmp_path / "claims.csv").read_text().splitlines()))
    assert (tuple(rows[0]), len(rows)) == (FOREST, len(all_judged))
    assert {row["verdict"] for row in rows} <= set(VERDICTS)
    assert {path.suffix for path in tmp_path.iterdir()} == {".csv", ".pdf", ".svg", ".png"}


def test_labels_fit_beside_their_rows(settings: Settings) -> None:
    assert [name for name, claim in settings.claims.items() if len(claim.says) > LONGEST_LABEL] == []

"""Bounds of claims: closed forms of the paper's number, two-sided, and nowhere wider than those before them."""

from typing import Any

import pytest
import yaml
from csv_files import GOLDEN

from mobnet.settings.claim_ranges import apart, common, range_text, ranges_of, within
from mobnet.evaluation.measure.claims.verdicts import rows_of
from mobnet.settings.claims import Bounds, Claim
from mobnet.settings.settings import Settings

ROUNDED = 0.05  # older bounds were rounded by less than this share
BY_SIGN = {"size-mob-net", "size-fts-e2e", "data-mob-net", "data-fts-e2e"}  # older ones were of pairs in order


def claim(rule: str, published: float | None = None, quantity: str = "value", **changes: Any) -> Claim:
    """Return a claim of which only what makes bounds is there."""
    kept: dict[str, Any] = {"bar": None, "side": None, **changes}
    return Claim.model_construct(rule=rule, published=published, quantity=quantity, **kept)


@pytest.mark.parametrize(
    ("made", "reproduced", "side"),
    [
        (claim("about", 4.0), (2.0, 8.0), (0.8, 20.0)),
        (claim("about", 4.0, bar=(3.0, None), side=(None, 10.0)), (3.0, 8.0), (0.8, 10.0)),
        (claim("larger", 4.0, "ratio"), (2.0, 8.0), (1.0, None)),
        (claim("larger", 0.25, "ratio"), (0.125, 0.5), (None, 1.0)),
        (claim("larger", 4.0, "least ratio"), (2.0, 8.0), (1.0, None)),
        (claim("larger", 0.75, "cut"), (0.5, 0.875), (0.0, 1.0)),
        (claim("larger", 4.0, "difference"), (2.0, 6.0), (0.0, None)),
        (claim("larger", 30.3, "ratio"), (15.15, 60.6), (1.0, None)),
        (claim("larger", 0.96, "cut"), (0.92, 0.98), (0.0, 1.0)),
        (claim("about", 0.9, "ratio"), (0.6, 1.35), (0.18, 4.5)),
        (claim("similar", 1.1, "ratio"), (1 / 1.21, 1.21), (0.5, 2.0)),
        (claim("similar", 0.8, "ratio"), (1 / 1.5, 1.5), (0.5, 2.0)),
        (claim("similar", 1.0, "ratio"), (1 / 1.1, 1.1), (0.5, 2.0)),
        (claim("similar", None, "ratio", bar=(0.9, 1.1)), (0.9, 1.1), (0.5, 2.0)),
        (claim("little", 2.0, "difference"), (1.0, 4.0), (None, 10.0)),
        (claim("sign", bar=(0.0, None)), (0.0, None), (0.0, None)),
        (claim("sign", bar=(None, 0.25), side=(None, 0.5)), (None, 0.25), (None, 0.5)),
    ],
)
def test_rules_make_bounds_of_the_number_of_the_paper(made: Claim, reproduced: Bounds, side: Bounds) -> None:
    """Closed forms, as the header of the claims states them."""
    found = ranges_of(made)
    assert found.reproduced == pytest.approx(reproduced)
    assert found.side == pytest.approx(side)


def test_a_growth_of_thirty_percent_does_not_reproduce_one_of_seven(settings: Settings) -> None:
    found = ranges_of(settings.claims["mob-net-at-floor"])
    assert not within((1.30, 1.30), found.reproduced)
    assert within((1.0, 1.07), found.reproduced)


def test_bounds_are_two_sided_around_a_number_of_the_paper_and_within_those_of_the_direction(
    settings: Settings,
) -> None:
    for row in rows_of(settings.claims):
        ranges, printed = ranges_of(row.claim), row.claim.published
        if printed is not None:
            assert None not in ranges.reproduced, row.name
            assert within((printed, printed), ranges.reproduced), row.name
        assert common(ranges.reproduced, ranges.side) == ranges.reproduced, row.name


def test_no_bound_is_wider_than_before(settings: Settings) -> None:
    older = yaml.safe_load((GOLDEN / "older_bounds.yaml").read_text())
    assert older.keys() <= settings.claims.keys()
    for name in older.keys() - BY_SIGN:
        ranges = ranges_of(settings.claims[name])
        for kind, before, now in zip(
            ("reproduced", "side"), older[name], (ranges.reproduced, ranges.side), strict=True
        ):
            for end, was, is_ in zip((-1.0, 1.0), before, now, strict=True):
                assert was is None or (is_ is not None and end * (is_ - was) <= ROUNDED * abs(was)), (name, kind)


def test_ranges_are_closed_and_read_aloud() -> None:
    assert within((1.0, 1.0), (1.0, 1.0))
    assert not within((0.9, 1.0), (1.0, None))
    assert not apart((0.9, 1.0), (1.0, None))
    assert apart((0.9, 0.99), (1.0, None))
    assert apart((3.0, 4.0), (None, 2.0))
    bounds: list[Bounds] = [(None, 2.0), (1.0, None), (1.0, 2.5), (None, None)]
    assert [range_text(each) for each in bounds] == ["at most 2", "at least 1", "1 to 2.5", "any"]

"""Bounds of claims: closed forms of the paper's number, and nowhere wider than those before them."""

from typing import Any

import pytest
import yaml
from csv_files import GOLDEN

from experiments.evaluation.measure.claims.verdicts import rows_of
from experiments.intervals.bounds import Bounds, apart, common, range_text, within
from experiments.settings.claim_ranges import ranges_of, shown_range
from experiments.settings.claims import Claim
from experiments.settings.settings import Settings
from experiments.settings.verdicts import NOT_PRINTED

ROUNDED = 0.05  # older bounds were rounded by less than this share
BY_SIGN = {"size-mob-net", "size-fts-e2e", "data-mob-net", "data-fts-e2e"}  # older ones were of pairs in order
BY_A_FIFTH = {  # the bar of an older comment, "within a fifth of all of them", which a factor of two had narrowed
    "found-or", "found-mean", "found-sigma", "found-fts", "found-fts-sigma", "found-mob", "found-mob-front",
    "found-mob-fric", "found-bpf",
}  # fmt: skip
BY_DIFFERENCE = {"support-gap"}  # the older one was a ratio


def claim(rule: str, published: float | None = None, quantity: str = "value", **changes: Any) -> Claim:
    """Return a claim of which only what makes bounds is there."""
    kept: dict[str, Any] = {"bar": None, "sign": None, **changes}
    return Claim.model_construct(rule=rule, published=published, quantity=quantity, **kept)


@pytest.mark.parametrize(
    ("made", "size", "sign"),
    [
        (claim("about", 4.0), (2.0, 8.0), None),
        (claim("about", 4.0, bar=(3.0, None)), (3.0, 8.0), None),
        (claim("about", 4.0, sign=(0.0, None)), (2.0, 8.0), (0.0, None)),
        (claim("at most", 4.0), (None, 8.0), None),
        (claim("share", 0.65), (0.45, 0.85), None),
        (claim("share", 0.1), (0.0, 0.3), None),
        (claim("share", 0.9), (0.7, 1.0), None),
        (claim("larger", 4.0, "ratio"), (2.0, 8.0), (1.0, None)),
        (claim("larger", 0.25, "ratio"), (0.125, 0.5), (None, 1.0)),
        (claim("larger", 4.0, "least ratio"), (2.0, 8.0), (1.0, None)),
        (claim("larger", 0.75, "cut"), (0.5, 0.875), (0.0, None)),
        (claim("larger", 4.0, "difference"), (2.0, 6.0), (0.0, None)),
        (claim("larger", 30.3, "ratio"), (15.15, 60.6), (1.0, None)),
        (claim("larger", 0.96, "cut"), (0.92, 0.98), (0.0, None)),
        (claim("about", 0.9, "ratio"), (0.6, 1.35), None),
        (claim("similar", 1.1, "ratio"), (1 / 1.21, 1.21), None),
        (claim("similar", 0.8, "ratio"), (1 / 1.5, 1.5), None),
        (claim("similar", 1.0, "ratio"), (1 / 1.1, 1.1), None),
        (claim("similar", None, "ratio", bar=(0.9, 1.1)), (0.9, 1.1), None),
        (claim("little", 2.0, "difference"), (1.0, 4.0), (0.0, None)),
        (claim("bar", bar=(None, 0.25)), (None, 0.25), None),
        (claim("bar", bar=(None, 0.67), sign=(None, 1.0)), (None, 0.67), (None, 1.0)),
        (claim("sign", sign=(0.0, None)), None, (0.0, None)),
    ],
)
def test_rules_make_bounds_of_the_number_of_the_paper(made: Claim, size: Bounds | None, sign: Bounds | None) -> None:
    """Closed forms, as the header of the claims states them."""
    found = ranges_of(made)
    assert (found.size is None) == (size is None)
    assert found.size is None or found.size == pytest.approx(size)
    assert found.sign == sign
    assert shown_range(found) == (found.size or sign)


def test_a_growth_of_thirty_percent_does_not_reproduce_one_of_seven(settings: Settings) -> None:
    size = ranges_of(settings.claims["mob-net-at-floor"]).size
    assert size is not None
    assert not within((1.30, 1.30), size)
    assert within((1.0, 1.07), size)


def test_bounds_are_two_sided_around_a_number_of_the_paper_and_within_those_of_the_sign(settings: Settings) -> None:
    for row in rows_of(settings.claims):
        ranges, printed = ranges_of(row.claim), row.claim.published
        if printed is not None:
            assert ranges.size is not None, row.name
            assert (None in ranges.size) == (row.claim.rule == "at most"), row.name
            assert within((printed, printed), ranges.size), row.name
        if ranges.size and ranges.sign and not row.claim.sign_of:  # so that no size lies inside with an opposite sign
            assert common(ranges.size, ranges.sign) == ranges.size, row.name


def test_every_claim_has_a_size_or_a_sign_and_our_own_no_number_of_the_paper(settings: Settings) -> None:
    for row in rows_of(settings.claims):
        ranges = ranges_of(row.claim)
        assert ranges.size or ranges.sign, row.name
        assert row.claim.printed != NOT_PRINTED or row.claim.published is None, row.name


def test_no_bound_is_wider_than_before_but_those_that_the_header_names(settings: Settings) -> None:
    older = yaml.safe_load((GOLDEN / "older_bounds.yaml").read_text())
    assert older.keys() <= settings.claims.keys()
    for name in older.keys() - BY_SIGN - BY_A_FIFTH - BY_DIFFERENCE:
        before, now = older[name][0], shown_range(ranges_of(settings.claims[name]))
        for end, was, is_ in zip((-1.0, 1.0), before, now, strict=True):
            assert was is None or (is_ is not None and end * (is_ - was) <= ROUNDED * abs(was)), name


def test_ranges_are_closed_and_read_aloud() -> None:
    assert within((1.0, 1.0), (1.0, 1.0))
    assert not within((0.9, 1.0), (1.0, None))
    assert not apart((0.9, 1.0), (1.0, None))
    assert apart((0.9, 0.99), (1.0, None))
    assert apart((3.0, 4.0), (None, 2.0))
    bounds: list[Bounds] = [(None, 2.0), (1.0, None), (1.0, 2.5), (None, None)]
    assert [range_text(each) for each in bounds] == ["at most 2", "at least 1", "1 to 2.5", "any"]

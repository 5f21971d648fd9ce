"""The page of the claims: one HTML file with a row for each statement, which opens its claims and joints.

The address holds what is shown (order, filters, opened statements): `claims.html#verdict=not+reproduced&sort=-ours`.
"""

import re
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import groupby
from operator import itemgetter
from pathlib import Path

from experiments.evaluation.measure.claims.verdicts import worst
from experiments.evaluation.number.number import Number, number_text
from experiments.evaluation.report.html import rendered
from experiments.intervals.bounds import ANY, Bounds, range_text
from experiments.settings.table_columns import CLAIMS
from experiments.settings.verdicts import OURS, SCORED, VERDICTS
from mobnet.core.rows import read_texts

WIDTH = 160.0  # of a picture
BAND = (0.3, 0.7)  # where the picture has the range that a claim names, shares of the width
REACH = 0.45  # of the width, for what lies farthest from the bound of a range that is open on one side
JOINT = re.compile("-([A-Z]+[0-9])$")  # names of claims are in lower case, but for their joint
PLACE = re.compile(r"abstract|not in the paper|(?:Table|Figure) \d+|section \d(?:\.\d)?")  # where a claim is printed
KINDS_OF_PLACES = ("abstract", "section", "Table", "Figure", "not")  # in the order of the menu


@dataclass(frozen=True)
class Plot:
    """A picture of a claim: places across a width of WIDTH, clipped to it; None where a claim has none.

    `band` is the range of the claimed size, or of the sign where no size is claimed, `side` that of the sign beside it.
    """

    band: tuple[float, float]
    side: tuple[float, float] | None
    published: float | None
    interval: tuple[float, float] | None
    value: float


@dataclass(frozen=True)
class ClaimRow:
    """A claim, or one of its joints, as the page shows it: a row of claims.csv."""

    name: str
    says: str
    printed: str
    verdict: str
    remark: str
    published: float | None
    value: float | None
    low: float | None
    high: float | None
    unit: str
    size: str
    sign: str
    claimed: Bounds
    side: Bounds | None

    @property
    def joint(self) -> str:
        """The joint that it is about; empty where it is about no single one of several."""
        found = JOINT.search(self.name)
        return found[1] if found else ""

    @property
    def paper_text(self) -> str:
        """The paper's number [unit]."""
        return number_text(self.published)

    @property
    def ours_text(self) -> str:
        """Our number with its unit."""
        text = Number(self.value, unit=self.unit).texts()[0]
        return text if self.unit == "-" or self.value is None else f"{text} {self.unit}"

    @property
    def interval_text(self) -> str:
        """Its interval [unit]."""
        return Number(self.value, self.low, self.high, unit=self.unit).texts()[1]

    @property
    def range_text(self) -> str:
        """The claimed range, with its unit."""
        return range_text(self.claimed) + ("" if self.unit == "-" else f" {self.unit}")

    @property
    def words(self) -> str:
        """The verdicts on its size and on its sign."""
        named = (("size", self.size), ("sign", self.sign))
        return ", ".join(f"{name} {word}" for name, word in named if word)

    @property
    def plot(self) -> Plot | None:
        """Its picture; None where there is no number of ours."""
        return None if self.value is None else plot_of(self)


@dataclass(frozen=True)
class Statement:
    """A statement with its claims, the first one first."""

    claims: Sequence[ClaimRow]
    name: str
    kind: str

    @property
    def first(self) -> ClaimRow:
        """The claim that the row of the statement shows."""
        return self.claims[0]

    @property
    def others(self) -> Sequence[ClaimRow]:
        """All claims but the first."""
        return self.claims[1:]

    @cached_property
    def verdict(self) -> str:
        """The worst verdict of its claims."""
        return worst([claim.verdict for claim in self.claims])

    @property
    def places(self) -> list[str]:
        """Where the paper prints its claims."""
        found: dict[str, None] = {}
        for claim in self.claims:
            found |= dict.fromkeys(places_of(claim.printed))
        return list(found)

    @property
    def summary(self) -> str:
        """How many claims and joints it has, and how many of them have which verdict."""
        joints = sum(bool(claim.joint) for claim in self.claims)
        numbers = {"claim": len(self.claims) - joints, "joint": joints}
        parts = [f"{n} {what}{'s' * (n != 1)}" for what, n in numbers.items() if n]
        counts = Counter(claim.verdict for claim in self.claims)
        return f"{' and '.join(parts)}: " + ", ".join(f"{counts[name]} {name}" for name in VERDICTS if counts[name])


def claims_page(claims_csv: Path, confidence: float, title: str, text: str, template: Path) -> str:
    """Return the page of all claims, from claims.csv; `confidence` is that of the intervals, a share [-].

    The title is text, what stands below it is HTML.

    Raises:
        DataError: the file is missing or damaged.
    """
    statements = read_statements(claims_csv)
    # Claims that the paper does not make say nothing about whether it is reproduced: they are counted apart.
    papers = [one for one in statements if one.kind != OURS]
    places: set[str] = set()
    for statement in statements:
        places.update(statement.places)
    return rendered(
        template,
        title=title,
        text=text,
        confidence=confidence,
        statements=statements,
        kinds=SCORED,
        linked=True,
        counts=verdict_counts(papers),
        firsts=first_counts(papers),
        ours=verdict_counts([one for one in statements if one.kind == OURS]),
        order={name: k for k, name in enumerate(VERDICTS)},
        places=sorted(places, key=_order_of_place),
    )


def verdict_counts(statements: Sequence[Statement]) -> dict[str, int]:
    """Return verdict -> how many statements have it."""
    found = Counter(statement.verdict for statement in statements)
    return {verdict: found[verdict] for verdict in VERDICTS}


def first_counts(statements: Sequence[Statement]) -> dict[str, int]:
    """Return verdict -> how many statements would have it by their first claim alone."""
    found = Counter(statement.first.verdict for statement in statements)
    return {verdict: found[verdict] for verdict in VERDICTS}


def read_statements(claims_csv: Path) -> list[Statement]:
    """Read the claims by statement, in the order in which statements begin.

    Raises:
        DataError: the file is missing or damaged.
    """
    rows = read_texts(claims_csv, CLAIMS)
    first = {row["statement"]: k for k, row in reversed([*enumerate(rows)])}
    # A claim may stand far below the one that begins its statement, and `groupby` takes neighbours alone.
    rows.sort(key=lambda row: first[row["statement"]])
    statements: list[Statement] = []
    for name, group in groupby(rows, key=itemgetter("statement")):
        own = list(group)
        statements.append(Statement([_claim(row) for row in own], name, own[0]["score"]))
    return statements


def _claim(row: Mapping[str, str]) -> ClaimRow:
    """Return a row of claims.csv with its numbers."""
    names = ("published", "value", "low", "high", "from", "to", "sign_from", "sign_to")
    published, value, low, high, *ends = (float(row[name]) if row[name] else None for name in names)
    size = (ends[0], ends[1])
    sign = (ends[2], ends[3])
    has_own_sign = row["sign_value"] == row["value"]  # a sign of another number has another axis
    is_sized = size != ANY
    return ClaimRow(
        name=row["claim"],
        says=row["says"],
        printed=row["printed"],
        verdict=row["verdict"],
        remark=row["remark"],
        published=published,
        value=value,
        low=low,
        high=high,
        unit=row["unit"],
        size=row["size"],
        sign=row["sign"],
        claimed=size if is_sized else sign,
        side=sign if is_sized and sign != ANY and has_own_sign else None,
    )


def places_of(printed: str) -> list[str]:
    """Return the tables, figures and sections that a text names; of a section it may give the number alone."""
    return PLACE.findall(re.sub(r"^(?=\d(\.\d)?,)", "section ", printed))


def _order_of_place(place: str) -> tuple[int, float, str]:
    kind, *number = place.split()
    return KINDS_OF_PLACES.index(kind), float(number[0]) if kind not in ("not", "abstract") else 0.0, place


def plot_of(claim: ClaimRow) -> Plot:
    """Return the picture of a claim that has a number."""
    low, high = claim.claimed
    known = [x for x in (claim.published, claim.value, claim.low, claim.high, *(claim.side or ())) if x is not None]

    def place(number: float) -> float:
        """Return the place of a number [unit of the claim]."""
        if low is not None and high is not None:
            share = BAND[0] + (BAND[1] - BAND[0]) * (number - low) / ((high - low) or 1.0)
        else:
            bound = (low if low is not None else high) or 0.0
            share = 0.5 + REACH * (number - bound) / (max(abs(x - bound) for x in known) or 1.0)
        return round(min(max(share, 0.0), 1.0) * WIDTH, 1)

    def span(bounds: Bounds) -> tuple[float, float]:
        first, last = bounds
        return (0.0 if first is None else place(first), WIDTH if last is None else place(last))

    held = claim.low is not None and claim.high is not None
    side = span(claim.side) if claim.side else None
    published = None if claim.published is None else place(claim.published)
    interval = span((claim.low, claim.high)) if held else None
    return Plot(span(claim.claimed), side, published, interval, place(claim.value or 0.0))

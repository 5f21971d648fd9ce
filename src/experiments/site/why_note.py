"""What the note on training says of the trial of why a hit is hidden: made from its kept table, no number is typed.

`python -m experiments.site why` writes it; a test fails when it is out of date.
"""

# pandas has no complete types, which the strict rules of this folder ask for.
# pyright: standard

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import pandas as pd

from experiments.evaluation.measure.learning.explained import (
    ALL,
    PATH,
    Learned,
    by_network,
    by_robot,
    over_shown_robots,
    read_why,
    spread_of,
)
from experiments.evaluation.measure.learning.paths import EVERY, INPUTS
from experiments.evaluation.measure.learning.taught import HITS, SHARE_OF_HIT, WALKING
from experiments.evaluation.number.frames import rows_of
from experiments.evaluation.number.number import Number, number_text
from experiments.evaluation.tables.layout import markdown_table
from experiments.intervals.bounds import Bounds, apart, range_text, within
from experiments.settings.claim_ranges import ranges_of, shown_range
from experiments.settings.load import load_settings
from experiments.settings.settings import Settings
from experiments.site.blocks import with_block
from mobnet.core.errors import DataError
from mobnet.core.files import read_text, write_text

NOTE = Path("docs/notes/training.md")
# Claims of configs/claims.yaml that are predictions of the trial, and what they say.
CLAIMS = {
    "imu-share": "share of a hit without the inertial sensor",
    "imu-share-more": "share of a hit, without the inertial sensor over with it",
    "imu-walk": "error in walking, without the inertial sensor over with it",
    "imu-fts-e2e": "error under hits without the inertial sensor, FTS-e2e over MOB-Net",
    "imu-rte-swing": "error under hits without the inertial sensor, without random torque over with it",
    "imu-rte-share": "share of a hit without the inertial sensor, with random torque over without it",
    "acc-share": "share of a hit, without the acceleration over with it",
    "acc-walk": "error in walking, without the acceleration over with it",
}
LEAST_RATIO = "imu-fts-e2e"  # the claim below whose range the same ratio lies with the original's inputs
WITH_TORQUE, WITHOUT_TORQUE, PLAIN = "why_walk", "why_plain", "-plain"  # sets; ending of a method that has the latter
SHOWN = "push_share"  # metric of a claim on shares of a hit
MISSED, OUTSIDE, UNDECIDED, HELD = "missed", "open, outside", "open", "held"  # in the order of the table
MOB_NET, END_TO_END = "MOB-Net", "FTS-e2e"
SPREAD = {WALKING: ("walking", "N m"), HITS: ("hits, LL3", "N m"), SHARE_OF_HIT: ("share of a hit", "-")}
Values = Mapping[str, Mapping[Learned, Mapping[str, float]]]  # measure -> networks -> robot -> number


class Predicted(NamedTuple):
    """What was predicted: networks of which one number or the ratio of two is meant, and its range [-]."""

    says: str
    name: str
    measure: str
    cells: Sequence[Learned]
    bounds: Bounds


def renew() -> None:
    """Write into the note what its trial found."""
    settings = load_settings()
    page = read_text(NOTE)
    for name, text in why_blocks(settings, Path(settings.evaluation.why_share.data)).items():
        page = with_block(page, name, text, NOTE)
    write_text(NOTE, page)


def why_blocks(settings: Settings, kept: Path) -> dict[str, str]:
    """Return block of the note -> its text: predictions, ways in of a hit, what seeds and robots change.

    Raises:
        DataError: the table is missing or damaged, or has not the networks of a prediction.
    """
    rows = read_why(kept)
    values: Values = {measure: by_robot(rows, measure) for measure in (WALKING, HITS, SHARE_OF_HIT)}
    return {
        "why_predicted": predicted(settings, values),
        "why_inputs": inputs(rows),
        "why_seeds": seeds(rows),
    }


def predictions_of(settings: Settings) -> list[Predicted]:
    """Return the predictions: those of claims, and two for the original's inputs."""
    way = _first(settings)
    predictions: list[Predicted] = []
    for name, says in CLAIMS.items():
        claim = settings.claims[name]
        at = claim.cells[0]
        measure = WALKING
        if at.scenario == settings.trials.why.as_in:
            measure = SHARE_OF_HIT if at.metric == SHOWN else HITS
        cells = [_cell(cell.method or "", way) for cell in claim.cells]
        predictions.append(Predicted(says, f"`{name}`", measure, cells, shown_range(ranges_of(claim))))
    least = shown_range(ranges_of(settings.claims[LEAST_RATIO]))[0]
    pair = [(WITH_TORQUE, method, way) for method in (END_TO_END, MOB_NET)]
    says = "error under hits with the original's inputs, FTS-e2e over MOB-Net"
    predictions.append(Predicted(says, "", HITS, pair, (None, least)))
    pair = [(data, MOB_NET, way) for data in (WITH_TORQUE, WITHOUT_TORQUE)]
    says = "share of a hit with the original's inputs, with random torque over without it"
    predictions.append(Predicted(says, "", SHARE_OF_HIT, pair, (None, 1.0)))
    return predictions


def _cell(method: str, way: str) -> Learned:
    """Return the networks of the trial that stand for a method of the run."""
    data = WITHOUT_TORQUE if method.endswith(PLAIN) else WITH_TORQUE
    return data, method.removesuffix(PLAIN), way


def predicted(settings: Settings, values: Values) -> str:
    """Return the table of predictions, those that missed first."""
    judged: list[tuple[str, list[str]]] = []
    for each in predictions_of(settings):
        number = _number(settings, [_of(values, each.measure, cell) for cell in each.cells])
        verdict = verdict_of(number, each.bounds)
        result = f"{number.text()} {number.interval()}"
        judged.append((verdict, [each.says, each.name, range_text(each.bounds), result, verdict]))
    judged.sort(key=lambda row: (MISSED, OUTSIDE, UNDECIDED, HELD).index(row[0]))
    return markdown_table(["prediction", "claim", "range", "result", ""], [row for _, row in judged], left=3)


def verdict_of(number: Number, bounds: Bounds) -> str:
    """Return whether an interval lies apart from a range or in it, or else whether the number itself lies outside."""
    value, low, high = number.range
    if value is None or low is None or high is None:
        return UNDECIDED
    if apart((low, high), bounds):
        return MISSED
    if within((low, high), bounds):
        return HELD
    return UNDECIDED if within((value, value), bounds) else OUTSIDE


def inputs(rows: pd.DataFrame) -> str:
    """Return a sentence for each method of which it was asked by which inputs a hit comes in."""
    shares: dict[str, dict[str, str]] = {}
    for row in rows_of(rows, measure=PATH, robot=ALL).to_dict("records"):
        shares.setdefault(row["method"], {})[row["inputs"]] = number_text(row["value"])
    lines: list[str] = []
    for method, texts in shares.items():
        parts = [f"{texts[name]} by {name}" for name in INPUTS]
        lines.append(f"* Of a hit, {texts[EVERY]} goes into the prediction of {method}: {', '.join(parts)}.")
    return "\n".join(lines)


def seeds(rows: pd.DataFrame) -> str:
    """Return the table of how far networks of a robot lie apart, and robots."""
    lines: list[list[str]] = []
    for measure, (says, unit) in SPREAD.items():
        pairs, networks, robots = spread_of(list(by_network(rows, measure).values()))
        lines.append([f"{says} [{unit}]", str(pairs), number_text(networks), number_text(robots)])
    head = ["", "pairs of networks", "standard deviation over seeds", "over robots, of means of two seeds"]
    return markdown_table(head, lines, left=1)


def _first(settings: Settings) -> str:
    """Return the way in which the networks of the run learn."""
    return next(iter(settings.trials.why.ways))


def _of(values: Values, measure: str, cell: Learned) -> Mapping[str, float]:
    """Return robot -> number of networks; a DataError where the trial has none."""
    if cell not in values[measure]:
        raise DataError(f"{', '.join(cell)}: these networks are missing, of which a prediction tells")
    return values[measure][cell]


def _number(settings: Settings, values: Sequence[Mapping[str, float]]) -> Number:
    """Return the mean of a measure, or the ratio of two, over the robots that both have."""
    common = set[str].intersection(*map(set, values))
    return over_shown_robots(values, sorted(common), settings.evaluation.statistics)

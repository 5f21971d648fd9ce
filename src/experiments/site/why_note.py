"""What the note on training says of the trial of why a hit is hidden: made from its kept table, no number is typed.

`python -m experiments.site why` writes it; a test fails when it is out of date.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from experiments.evaluation.measure.learning.explained import (
    ALL,
    FEW,
    PATH,
    HitNumber,
    LearnedCell,
    by_network,
    by_robot,
    over_robots,
    read_why,
    spread_of,
)
from experiments.evaluation.measure.learning.paths import EVERY, INPUTS
from experiments.evaluation.measure.learning.taught import HITS, ROUGHNESS, SHARE_OF_HIT, WALKING
from experiments.evaluation.number.number import Number, number_text, shown_name
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
MOB_NET, NO_SENSOR, END_TO_END = "MOB-Net", "MOB-Net-noimu", "FTS-e2e"
KINDS = (MOB_NET, NO_SENSOR, END_TO_END)
SPREAD = {WALKING: ("walking", "N m"), HITS: ("hits, LL3", "N m"), SHARE_OF_HIT: ("share of a hit", "-")}
Values = Mapping[str, Mapping[LearnedCell, Mapping[str, float]]]  # measure -> networks -> robot -> number


class Predicted(NamedTuple):
    """What was predicted: networks of which one number or the ratio of two is meant, and its range [-]."""

    says: str
    name: str
    measure: str
    cells: Sequence[LearnedCell]
    bounds: Bounds


def renew() -> None:
    """Write into the note what its trial found."""
    settings = load_settings()
    page = read_text(NOTE)
    for name, text in why_blocks(settings, Path(settings.evaluation.why_share.data)).items():
        page = with_block(page, name, text, NOTE)
    write_text(NOTE, page)


def why_blocks(settings: Settings, kept: Path) -> dict[str, str]:
    """Return block of the note -> its text: predictions, numbers on all robots, those on a few, and inputs.

    Raises:
        DataError: the table is missing or damaged, or has not the networks of a prediction.
    """
    rows = read_why(kept)
    values: Values = {measure: by_robot(rows, measure) for measure in (WALKING, HITS, SHARE_OF_HIT, ROUGHNESS)}
    return {
        "why_predicted": predicted(settings, values),
        "why_found": found(settings, values),
        "why_kinds": robots_and_ways(settings, values),
        "why_inputs": inputs(rows),
        "why_seeds": seeds(rows),
    }


def predictions_of(settings: Settings) -> list[Predicted]:
    """Return the predictions: those of claims, and two for the original's inputs."""
    way = _first(settings)
    found: list[Predicted] = []
    for name, says in CLAIMS.items():
        claim = settings.claims[name]
        at = claim.cells[0]
        measure = WALKING
        if at.scenario == settings.trials.why.as_in:
            measure = SHARE_OF_HIT if at.metric == SHOWN else HITS
        cells = [_cell(cell.method or "", way) for cell in claim.cells]
        found.append(Predicted(says, f"`{name}`", measure, cells, shown_range(ranges_of(claim))))
    least = shown_range(ranges_of(settings.claims[LEAST_RATIO]))[0]
    pair = [LearnedCell(WITH_TORQUE, method, way) for method in (END_TO_END, MOB_NET)]
    says = "error under hits with the original's inputs, FTS-e2e over MOB-Net"
    found.append(Predicted(says, "", HITS, pair, (None, least)))
    pair = [LearnedCell(data, MOB_NET, way) for data in (WITH_TORQUE, WITHOUT_TORQUE)]
    says = "share of a hit with the original's inputs, with random torque over without it"
    found.append(Predicted(says, "", SHARE_OF_HIT, pair, (None, 1.0)))
    return found


def _cell(method: str, way: str) -> LearnedCell:
    """Return the networks of the trial that stand for a method of the run."""
    data = WITHOUT_TORQUE if method.endswith(PLAIN) else WITH_TORQUE
    return LearnedCell(data, method.removesuffix(PLAIN), way)


def predicted(settings: Settings, values: Values) -> str:
    """Return the table of predictions, those that missed first."""
    told: list[tuple[str, list[str]]] = []
    for one in predictions_of(settings):
        number = _number(settings, [_of(values, one.measure, cell) for cell in one.cells])
        verdict = verdict_of(number, one.bounds)
        told.append((verdict, [one.says, one.name, range_text(one.bounds), _text(number), verdict]))
    told.sort(key=lambda row: (MISSED, OUTSIDE, UNDECIDED, HELD).index(row[0]))
    return markdown_table(["prediction", "claim", "range", "found", ""], [row for _, row in told], left=3)


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


def found(settings: Settings, values: Values) -> str:
    """Return the table of networks that differ in what they see, over all robots."""
    rows: list[list[str]] = []
    for cell in values[WALKING]:
        if cell.data in (WITH_TORQUE, WITHOUT_TORQUE) and len(values[WALKING][cell]) > FEW:
            name = _name(settings, cell)
            measures = (WALKING, HITS, SHARE_OF_HIT, ROUGHNESS)
            numbers = [_number(settings, [values[measure][cell]]) for measure in measures]
            torque = "yes" if cell.data == WITH_TORQUE else "no"
            rows.append([name, torque if cell.way else "", *map(_text, numbers[:3]), numbers[3].text()])
    # Methods that do not learn are the same beside both sets.
    rows = [row for k, row in enumerate(rows) if row not in rows[:k]]
    head = ["networks", "random torque", "walking [N m]", "hits, LL3 [N m]", "share of a hit", "roughness"]
    return markdown_table(head, rows, left=2)


def robots_and_ways(settings: Settings, values: Values) -> str:
    """Return the table of robots and ways of learning on a few robots: shares of a hit, and what the sensor saves."""
    shown = settings.evaluation.why_share
    way = _first(settings)
    told = {LearnedCell(WITH_TORQUE, MOB_NET, way): "robots and learning of the run"}
    for data, own in shown.sets.items():
        if own.over == data != WITH_TORQUE:
            told[LearnedCell(data, MOB_NET, way)] = own.says
    for name, says in shown.ways.items():
        told[LearnedCell(WITH_TORQUE, MOB_NET, name)] = says
    robots = settings.trials.why.path_robots
    rows: list[list[str]] = []
    for cell, says in told.items():
        own = [cell._replace(method=method) for method in KINDS]
        shares = [values[SHARE_OF_HIT].get(each) for each in own]
        walking = [values[WALKING].get(each) for each in own[1::-1]]
        if any(shares):
            row = [_text(_number(settings, [each], robots)) if each else "" for each in shares]
            both = [each for each in walking if each]
            row.append(_text(_number(settings, both, robots)) if len(both) == len(walking) else "")
            rows.append([says, *row])
    head = ["", *(f"share, {method}" for method in KINDS), f"walking, {NO_SENSOR} over {MOB_NET}"]
    return markdown_table(head, rows, left=1)


def inputs(rows: Sequence[HitNumber]) -> str:
    """Return a sentence for each method of which it was asked by which inputs a hit comes in."""
    shares: dict[str, dict[str, str]] = {}
    for row in rows:
        if row.measure == PATH and row.robot == ALL:
            shares.setdefault(row.method, {})[row.inputs] = number_text(row.value)
    lines: list[str] = []
    for method, own in shares.items():
        parts = [f"{own[name]} by {name}" for name in INPUTS]
        lines.append(f"* Of a hit, {own[EVERY]} goes into the prediction of {method}: {', '.join(parts)}.")
    return "\n".join(lines)


def seeds(rows: Sequence[HitNumber]) -> str:
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


def _name(settings: Settings, cell: LearnedCell) -> str:
    """Return what networks, or a method without any, are called."""
    for name, own in settings.evaluation.why_share.networks.items():
        if own.method == cell.method and cell.way in own.ways:
            return name
    return shown_name(cell.method)


def _of(values: Values, measure: str, cell: LearnedCell) -> Mapping[str, float]:
    """Return robot -> number of networks; a DataError where the trial has none."""
    if cell not in values[measure]:
        raise DataError(f"{', '.join(cell)}: these networks are missing, of which a prediction tells")
    return values[measure][cell]


def _number(settings: Settings, values: Sequence[Mapping[str, float]], robots: Sequence[str] = ()) -> Number:
    """Return the mean of a measure, or the ratio of two, over the robots that both have, or over some of them."""
    common = set[str].intersection(*map(set, values))
    chosen = [robot for robot in sorted(common) if not robots or robot in robots]
    return over_robots(values, chosen, settings.evaluation.statistics)


def _text(number: Number) -> str:
    """Return a number with its interval in brackets, or with the numbers of a few robots in parentheses."""
    ends = number.interval()
    if max(number.networks, default=0) <= FEW:
        ends = ends.replace("[", "(").replace("]", ")")
    return f"{number.text()} {ends}"

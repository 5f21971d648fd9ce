"""Table of the kinds of networks (section 6.1): losses, errors and sizes, beside the paper's order.

The time that a training takes is in the page of runs: tables come out the same each time.
"""

from __future__ import annotations

import logging
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from mobnet.core.config import read_yaml
from mobnet.core.files import write_text
from mobnet.evaluation.measure.trainings import MEASURES, Training, read_trainings, sound
from mobnet.evaluation.number.intervals import summarise
from mobnet.evaluation.number.rows import write_rows
from mobnet.evaluation.tables.layout import GAP, RULE, Line, markdown_table, number, span, text_table

log = logging.getLogger(__name__)

ORDERED_BY = "validation loss"
DIGITS = 2
HEADER = ["Order", "Paper", "Network", "Parameters", "Paper", "Runs", "Val. loss", "RMSE [N m]",
          "On windows", "Train. loss, end", "Val. loss, end"]  # fmt: skip
LEFT = 3  # columns of text
Numbers = dict[str, tuple[float, float | None, float | None]]  # measure -> mean and ends of its interval


@dataclass(frozen=True)
class Trait:
    """One number of a kind of network: a row of kinds.csv.

    Attributes:
        method: row of the configuration's methods.
        quantity: `parameters`, `order`, `runs`, `diverged` or a name of `MEASURES`.
        value: the number, a mean over the runs that did not diverge [unit]; None where there is none.
        low: lower end of its interval [unit]; None where there is none.
        high: upper end of its interval [unit]; None where there is none.
        unit: unit of the numbers.
        published: the paper's number [unit]; None where it prints none.
    """

    method: str
    quantity: str
    value: float | None
    low: float | None
    high: float | None
    unit: str
    published: float | None


def kinds(config: Mapping[str, Any], folders: Sequence[str], out_dir: Path) -> None:
    """Write kinds.csv, .tex and .md: mean over runs of loss (22) [-] and RMSE [N m], best kind first.

    Args:
        config: resolved configuration: `seed`, `published`, `evaluation.figure_17` (`methods`, the paper's kinds),
            `evaluation.kinds` (`variants`, our own, shown below) and what intervals need.
        folders: of the trained networks of all of them.
        out_dir: gets the three files.

    Raises:
        DataError: a file is missing or damaged.
    """
    found, settings = read_trainings(folders), config["evaluation"]
    papers, variants = settings["figure_17"]["methods"], settings["kinds"]["variants"]
    published = read_yaml(Path(config["published"]))["kinds"]
    numbers = {method: measured(config, found[method]) for method in (*papers, *variants)}
    shown = ordered(papers, numbers)
    ranks = {name: k for k, name in enumerate([name for name in shown if name in published["order"]], start=1)}
    traits = [
        trait
        for method in (*shown, *variants)
        for trait in traits_of(method, found[method], numbers[method], ranks.get(method), published)
    ]
    write_rows(out_dir / "kinds.csv", Trait, traits)
    lines = kind_lines(traits, variants, settings["confidence"])
    columns = "rrl" + "r" * (len(HEADER) - LEFT)
    write_text(out_dir / "kinds.tex", text_table(columns, HEADER, lines))
    write_text(out_dir / "kinds.md", markdown_table(HEADER, lines, left=LEFT))
    log.info("%s: %s", out_dir / "kinds.csv", ", ".join(numbers))


def measured(config: Mapping[str, Any], trainings: Sequence[Training]) -> Numbers:
    """Return the measures of the trainings that did not diverge: mean and interval [-, N m]; empty if all did."""
    good = sound(trainings)
    if not good:
        return {}
    grids = {name: np.array([[measure(run)] for run in good]) for name, (measure, _) in MEASURES.items()}
    summaries = {name: summarise([grid], config) for name, grid in grids.items()}
    return {name: (summary.value, summary.low, summary.high) for name, summary in summaries.items()}


def ordered(methods: Sequence[str], numbers: Mapping[str, Numbers]) -> list[str]:
    """Return methods by their mean validation loss [-], lowest first; those that always diverged come last."""
    return sorted(methods, key=lambda method: numbers[method].get(ORDERED_BY, (float("inf"), None, None))[0])


def traits_of(
    method: str, trainings: Sequence[Training], numbers: Numbers, rank: int | None, published: Mapping[str, Any]
) -> Iterator[Trait]:
    """Yield all numbers of a kind; `rank` is its place [-] among the kinds that the paper orders, None for others."""
    printed = published["order"].get(method)
    yield Trait(method, "order", rank, None, None, "-", printed)
    yield Trait(method, "parameters", trainings[0].parameters, None, None, "-", published["parameters"].get(method))
    yield Trait(method, "runs", len(trainings), None, None, "-", None)
    yield Trait(method, "diverged", len(trainings) - len(sound(trainings)), None, None, "-", None)
    for name, (_, unit) in MEASURES.items():
        yield Trait(method, name, *numbers.get(name, (None, None, None)), unit, None)


def kind_lines(traits: Sequence[Trait], variants: Sequence[str], confidence: float) -> list[Line]:
    """Return the rows of text, two a kind where there are intervals, a rule above our own variants.

    Args:
        traits: all numbers, kind by kind.
        variants: kinds below the rule.
        confidence: of the intervals, a share [-].
    """
    lines: list[Line] = []
    for method in dict.fromkeys(trait.method for trait in traits):
        if lines:
            lines.append(RULE if method in variants[:1] else GAP)
        lines += method_lines({trait.quantity: trait for trait in traits if trait.method == method}, confidence)
    return lines


def method_lines(own: Mapping[str, Trait], confidence: float) -> list[Line]:
    """Return a kind's row of text and that of its intervals; `confidence` is a share [-]."""
    order, size, runs, diverged = (own[name] for name in ("order", "parameters", "runs", "diverged"))
    count = number(runs.value, 0) + (f", {number(diverged.value, 0)} diverged" if diverged.value else "")
    names = [number(order.value, 0), number(order.published, 0), order.method]
    sizes = [number(size.value, 0), number(size.published, 0), count]
    lines: list[Line] = [[*names, *sizes, *(number(own[name].value, DIGITS) for name in MEASURES)]]
    if any(own[name].low is not None for name in MEASURES):
        spans = [span(own[name].low, own[name].high, DIGITS) for name in MEASURES]
        lines.append(["", "", "", "", "", f"{confidence:.0%}", *spans])
    return lines

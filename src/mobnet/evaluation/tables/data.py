"""What the training sets are: how long, on which ground, which commands of Table 2, how the upper body moved."""

from __future__ import annotations

import logging
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from mobnet.control.parameters import DURATION
from mobnet.core.config import read_yaml
from mobnet.core.files import read_json, write_text
from mobnet.core.recording import COMMAND, recording_columns
from mobnet.core.store import read_array
from mobnet.evaluation.measure.steps import CHOICES, KEYS, UNITS, Sets, in_degrees, read_steps
from mobnet.evaluation.measure.upper_body import upper_body
from mobnet.evaluation.number.rows import write_rows
from mobnet.evaluation.tables.layout import markdown_table, text_table
from mobnet.robot.description import load_robot
from mobnet.robot.nominal import NominalModel

log = logging.getLogger(__name__)

Found = tuple[str, str, float, str]  # quantity, part, value, unit

EDGE = 1e-3  # [-] of a range: a command nearer than this to its end counts as on the edge
MINUTE_S = 60.0
FORMATS: Mapping[str, Callable[[float], str]] = {
    "-": "{:.0%}".format,
    "": "{:.0f}".format,
    "min": "{:.1f}".format,
    "deg": "{:.1f}".format,
    "rad": "{:.2f}".format,
    "m/s": "{:.2f}".format,
}
PLAIN = "{:.3f}".format


@dataclass(frozen=True)
class Fact:
    """One number about a training set: a row of data.csv.

    Attributes:
        set: training set.
        quantity: what is counted or measured.
        part: command, terrain or joint that it belongs to; empty where it is the whole set's.
        value: the number [unit].
        unit: unit; empty for a count, `-` for a share.
        published: the paper's number [unit]; None where it gives none.
    """

    set: str
    quantity: str
    part: str
    value: float
    unit: str
    published: float | None


def data(config: Mapping[str, Any], sets: Sets, out_dir: Path) -> None:
    """Write data.csv, .tex and .md.

    Args:
        config: resolved configuration: `robot`, `published`, `walking`, `commands`, `terrain`,
            `evaluation.data`.
        sets: name -> stems of the recordings.
        out_dir: gets the three files.

    Raises:
        DataError: a file or a column is missing, or a set holds no step.
    """
    printed = read_yaml(Path(config["published"]))["data"]["sets"]
    nominal = NominalModel(load_robot(Path(config["robot"])))
    rows: list[Fact] = []
    for name, texts in sets.items():
        stems = list(map(Path, texts))
        known = printed.get(name, {})
        found = [
            *extent(stems, list(config["terrain"])),
            *commanded(config, stems, nominal),
            *upper_body(config, stems, nominal),
        ]
        rows += [Fact(name, *fact, _published(config, known, *fact[:2])) for fact in found]
    header = ["", *(name.replace("_", " ") for name in sets), "Paper"]
    lines = fact_lines([row for row in rows if row.part not in nominal.robot.layout.actuated], list(sets))
    write_rows(out_dir / "data.csv", Fact, rows)
    write_text(out_dir / "data.tex", text_table("l" + "r" * len(header[1:]), header, lines))
    write_text(out_dir / "data.md", markdown_table(header, lines))
    log.info("%s: %d facts", out_dir / "data.csv", len(rows))


def extent(stems: Sequence[Path], terrains: Sequence[str]) -> Iterator[Found]:
    """Yield length [min], samples, falls, episodes and the shares of the terrains [-] of recordings.

    Raises:
        DataError: a file is missing.
    """
    notes = [read_json(stem.with_suffix(".json")) for stem in stems]
    yield "recordings", "", len(notes), ""
    yield "duration", "", sum(note["rows"] / note["rate_hz"] for note in notes) / MINUTE_S, "min"
    yield "samples", "", sum(note["rows"] for note in notes), ""
    yield "falls", "", sum(note["falls"] for note in notes), ""
    yield "episodes", "", sum(len(note["segments"]) for note in notes), ""
    yield from ground(notes, terrains)
    clearances = [note["clearance_min_m"] for note in notes if "clearance_min_m" in note]
    if clearances:
        yield "smallest self-clearance", "", min(clearances), "m"


def ground(notes: Sequence[Mapping[str, Any]], terrains: Sequence[str]) -> Iterator[Found]:
    """Yield the share of the samples on each terrain [-], as the recordings note it segment by segment."""
    walked: Counter[str] = Counter()
    for note in notes:
        for (start, end), terrain in zip(note["segments"], note["terrains"], strict=True):
            walked[terrain] += end - start
    for terrain in terrains:
        yield "time on terrain", terrain, walked[terrain] / walked.total(), "-"


def commanded(config: Mapping[str, Any], stems: Sequence[Path], nominal: NominalModel) -> Iterator[Found]:
    """Yield the time standing [-], the steps, and of each command its ends [m], [deg], [s] and the share on them [-].

    Raises:
        DataError: a file or a column is missing, or nothing is walked.
    """
    column = recording_columns(nominal.robot.layout)["command"][DURATION][0]
    duration = np.concatenate([read_array(stem, [column])[0][:, 0] for stem in stems])
    yield "time standing", "", float(np.mean(duration == 0.0)), "-"
    steps = in_degrees(read_steps(stems, nominal, config["walking"]["foot_spacing_m"]))
    yield "steps", "", len(steps), ""
    for k, (name, _) in enumerate(COMMAND):
        values, ends = steps.commanded[:, k], np.array(config["commands"][KEYS[k]], dtype=float)[[0, -1]]
        yield "smallest command", name, float(values.min()), UNITS[k]
        yield "largest command", name, float(values.max()), UNITS[k]
        near = np.abs(values[:, None] - ends).min(axis=1) <= EDGE * (ends[1] - ends[0])
        yield "steps on an edge", name, float(near.mean()), "-"
        follows = steps.follows(k)
        if k < CHOICES and follows.any():
            size, got = np.abs(values[follows]), steps.measured[follows, k] * np.sign(values[follows])
            yield "measured over commanded", name, float(got.sum() / size.sum()), "-"


def _published(config: Mapping[str, Any], known: Mapping[str, float], quantity: str, part: str) -> float | None:
    """Return the paper's number: an end of Table 2's range, or what it says of the set."""
    if quantity in ("smallest command", "largest command"):
        key = KEYS[[name for name, _ in COMMAND].index(part)]
        return float(config["commands"][key][0 if quantity.startswith("smallest") else -1])
    return known.get(quantity)


def fact_lines(rows: Sequence[Fact], sets: Sequence[str]) -> list[list[str]]:
    """Return the rows of text: a quantity a row, a set a column, the paper's number last."""
    lines = []
    for quantity, part, unit in dict.fromkeys((row.quantity, row.part, row.unit) for row in rows):
        own = {row.set: row for row in rows if (row.quantity, row.part) == (quantity, part)}
        show = FORMATS.get(unit, PLAIN)
        label = f"{quantity}, {part.replace('_', ' ')}" if part else quantity
        cells = [show(own[name].value) if name in own else "-" for name in sets]
        printed = next((row.published for row in own.values() if row.published is not None), None)
        label += f" [{unit}]" if unit not in ("", "-") else ""
        lines.append([label, *cells, "-" if printed is None else show(printed)])
    return lines

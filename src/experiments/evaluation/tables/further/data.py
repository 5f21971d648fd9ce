"""What the training sets are: how long, on which ground, which commands of Table 2, how the upper body moved."""

# pandas has no complete types, which the strict rules of this folder ask for.
# pyright: standard

from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from experiments.evaluation.measure.data.random_torque import torque_left
from experiments.evaluation.measure.data.steps import CHOICES, KEYS, UNITS, read_steps
from experiments.evaluation.measure.data.upper_body import upper_body
from experiments.evaluation.number.number import is_missing
from experiments.evaluation.tables.look import Row, ShownColumn, TableLook, write_look
from experiments.settings.published import PublishedData
from experiments.settings.table_columns import DATA
from experiments.settings.tables import DataTable
from mobnet.control.steps import DURATION
from mobnet.core.columns import COMMAND, recording_columns
from mobnet.core.errors import refuse_lines
from mobnet.core.notes import read_array_note
from mobnet.core.store import NOTE, file_of, read_array
from mobnet.formats.robot import RobotTable
from mobnet.robot.description import describe
from mobnet.robot.nominal import NominalModel
from mobnet.settings.data import Commands, RecordingSettings, Terrain
from mobnet.settings.walking import Walking

Fact = tuple[str, str, float, str]  # quantity, part (empty: the whole set's), value, unit

EDGE = 1e-3  # [-] of a range: a command nearer than this to its end counts as on the edge
MINUTE_S = 60.0
FORMATS = {"-": ".0%", "": ".0f", "min": ".1f", "deg": ".1f", "rad": ".2f", "m/s": ".2f"}  # of numbers by unit
PLAIN = ".3f"


def data(
    settings: DataTable,
    robot: RobotTable,
    walking: Walking,
    commands: Commands,
    terrain: Terrain,
    recording: RecordingSettings,
    published: PublishedData,
    sets: Mapping[str, Sequence[Path]],
    table_dir: Path,
) -> None:
    """Write data.csv, .tex and .md: what the recordings of each set hold, beside what the paper says of them.

    The text leaves out single joints, and sets that it is not asked to show.
    """
    nominal = NominalModel(describe(robot))
    rows: list[tuple[str, str, str, float, str, float | None]] = []
    for name, stems in sets.items():
        facts = [
            *extent(stems, [name for name, row in terrain if row is not None], recording.clearance_hz),
            *commanded(commands, walking.foot_spacing_m, stems, nominal),
            *upper_body(settings.every, stems, nominal),
            *torque_left(stems, nominal.robot.layout, settings.limbs, settings.lags_s),
        ]
        for quantity, part, value, unit in facts:
            printed = _published(commands, published.sets.get(name, {}), quantity, part)
            rows.append((name, quantity, part, value, unit, printed))
    table = pd.DataFrame(rows, columns=list(DATA)).astype({"value": object, "published": float})
    shown = table[table["set"].isin(settings.shown) & ~table["part"].isin(nominal.robot.layout.actuated)]
    look = look_at([name for name in sets if name in settings.shown])
    write_look(table_dir / "data", with_labels(shown), DATA, look, filed=table)


def with_labels(facts: pd.DataFrame) -> pd.DataFrame:
    """Return facts, columns `DATA`, with what a line calls each, and the paper's number of the first set that has one.

    A line is a quantity, of the whole sets or of a part of them.
    """
    labels = [_label(row) for row in facts.to_dict("records")]
    paper = facts.groupby(["quantity", "part"])["published"].transform("first")
    return facts.assign(label=labels, paper=paper)


def look_at(sets: Sequence[str]) -> TableLook:
    """Return what a reader sees: a quantity a line, a set a column, the paper's number last."""
    shown = [ShownColumn(name.replace("_", " "), {"set": name}, text=_text("value")) for name in sets]
    return TableLook({"label": ""}, [*shown, ShownColumn("Original", text=_text("paper"))])


def _label(row: Row) -> str:
    """Return what a line calls a quantity: with its part, and its unit."""
    part = f", {row['part'].replace('_', ' ')}" if row["part"] else ""
    unit = f" [{row['unit']}]" if row["unit"] not in ("", "-") else ""
    return row["quantity"] + part + unit


def _text(name: str) -> Callable[[Row], str]:
    """Return the text of a column of a row, in the format of its unit."""
    return lambda row: "-" if is_missing(row[name]) else format(row[name], FORMATS.get(row["unit"], PLAIN))


def extent(stems: Sequence[Path], terrains: Sequence[str], clearance_hz: float) -> Iterator[Fact]:
    """Yield length [min], samples, falls, episodes and the shares of the terrains [-] of recordings.

    Of those in which self-collisions were looked for at a rate [Hz], also the least distance [m], and the time in which
    solids overlap [-].
    """
    notes = [read_array_note(file_of(stem, NOTE)) for stem in stems]
    faults = []
    for stem, note in zip(stems, notes, strict=True):
        for key in ("falls", "terrains"):
            if key not in note:
                faults.append(f"{stem}{NOTE}: {key}: key is missing; accepted: what the simulator writes")
    refuse_lines(faults)
    yield "recordings", "", len(notes), ""
    yield "duration", "", sum(note["rows"] / note["rate_hz"] for note in notes) / MINUTE_S, "min"
    yield "samples", "", sum(note["rows"] for note in notes), ""
    yield "falls", "", sum(note["falls"] for note in notes), ""
    yield "episodes", "", sum(len(note["segments"]) for note in notes), ""
    yield from ground(notes, terrains)
    watched = [note for note in notes if "clearance_min_m" in note]
    if watched:
        looks = sum(note["rows"] / note["rate_hz"] for note in watched) * clearance_hz
        yield "smallest self-clearance", "", min(note["clearance_min_m"] for note in watched), "m"
        yield "time in self-collision", "", sum(note.get("self_collisions", 0) for note in watched) / looks, "-"


def ground(notes: Sequence[Mapping[str, Any]], terrains: Sequence[str]) -> Iterator[Fact]:
    """Yield the share of the samples on each terrain [-], as the recordings note it segment by segment."""
    walked: Counter[str] = Counter()
    for note in notes:
        for (start, end), terrain in zip(note["segments"], note["terrains"], strict=True):
            walked[terrain] += end - start
    for terrain in terrains:
        yield "time on terrain", terrain, walked[terrain] / walked.total(), "-"


def commanded(commands: Commands, spacing_m: float, stems: Sequence[Path], nominal: NominalModel) -> Iterator[Fact]:
    """Yield the time standing [-], the steps, and of a command its ends [m], [deg], [s] and the share on them [-]."""
    column = recording_columns(nominal.robot.layout)["command"][DURATION][0]
    duration = np.concatenate([read_array(stem, [column])[0][:, 0] for stem in stems])
    yield "time standing", "", float(np.mean(duration == 0.0)), "-"
    steps = read_steps(stems, nominal.robot.layout)
    measured = steps.measured(nominal, spacing_m)
    yield "steps", "", len(steps), ""
    for k, (name, _) in enumerate(COMMAND):
        values = steps.commanded[:, k]
        ends = np.array(getattr(commands, KEYS[k]), dtype=float)[[0, -1]]
        yield "smallest command", name, float(values.min()), UNITS[k]
        yield "largest command", name, float(values.max()), UNITS[k]
        near = np.abs(values[:, None] - ends).min(axis=1) <= EDGE * (ends[1] - ends[0])
        yield "steps on an edge", name, float(near.mean()), "-"
        follows = steps.follows(k)
        if k < CHOICES and follows.any():
            size = np.abs(values[follows])
            got = measured[follows, k] * np.sign(values[follows])
            yield "measured over commanded", name, float(got.sum() / size.sum()), "-"


def _published(commands: Commands, known: Mapping[str, float], quantity: str, part: str) -> float | None:
    """Return the paper's number: an end of Table 2's range, or what it says of the set."""
    if quantity in ("smallest command", "largest command"):
        key = KEYS[[name for name, _ in COMMAND].index(part)]
        return float(getattr(commands, key)[0 if quantity.startswith("smallest") else -1])
    return known.get(quantity)

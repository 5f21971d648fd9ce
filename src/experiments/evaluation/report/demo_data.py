"""The stored push: a few seconds of a recording, with all that makes its estimates, small enough for the repository.

`./reproduce snapshot` copies it to docs/demo, where `./reproduce demo` reads it (`experiments.demo`).
"""

import logging
import shutil
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import astuple
from pathlib import Path
from typing import Any

from experiments.evaluation.number.rows import read_detections
from experiments.evaluation.report.manifest import file_hash
from experiments.plan.demo import RECORDING, SOURCES, estimate_place
from experiments.records.collisions import Collision, columns_of
from experiments.settings.pages import Story
from mobnet.core.code import provenance
from mobnet.core.columns import EXTERNAL, PUSH, PUSH_TORQUE, STD, named, recording_columns, torque_columns
from mobnet.core.detections import COLLISION
from mobnet.core.errors import DataError, not_accepted
from mobnet.core.files import atomic_path, read_json, write_json, write_text
from mobnet.core.joints import JointLayout
from mobnet.core.notes import read_array_note
from mobnet.core.recording import Sensed
from mobnet.core.rows import csv_text
from mobnet.core.store import ARRAY, NOTE, file_of, read_array, spans_and_rate, write_array

OWN = ("rows", "segments", "columns", "footer", "stamp", "terrains")  # of an array's note, of its own rows
KEPT = (*Sensed.__dataclass_fields__, EXTERNAL, PUSH_TORQUE, PUSH)  # of a recording: sensed, and what pushes did
log = logging.getLogger(__name__)


def demo_data(
    settings: Story,
    scale: str,
    layout: JointLayout,
    limb: str,
    pushes: Sequence[str],
    recording: Path,
    estimates: Mapping[str, Path],
    copied: Mapping[str, Path],
    detections: Mapping[str, Path],
    out: Path,
) -> None:
    """Write the files of the stored push beside `out`, which says what each of them is made from, with its hash.

    Args:
        settings: which push, and the time around it.
        scale: of the run.
        layout: the robot's joints.
        limb: that whose joints are kept of estimates.
        pushes: those of the scenario, in their order.
        recording: the first one of the test.
        estimates: of this recording, by method.
        copied: place below the folder -> file that is copied there as it is.
        detections: files of the robot's detectors, of which the rows of the push and of the detector are kept.
        out: the description of the files, written last.

    Raises:
        DataError: a file is missing or damaged, or the recording lacks the push or a part of the time around it.
    """
    seed = int(recording.name.removeprefix("s"))
    collision = _collision(settings, limb, seed, detections["collisions"])
    rows = _window(settings, pushes, recording)
    columns: list[tuple[str, str, str]] = []
    for field, group in recording_columns(layout).items():
        if field in KEPT:
            columns += group
    _cut(recording, columns, rows, out.with_name(RECORDING))
    for method, stem in estimates.items():
        held = {column["name"] for column in read_array_note(file_of(stem, NOTE))["columns"]}
        signals = [signal for signal in (EXTERNAL, STD) if held.issuperset(named(signal, layout.limb(limb)))]
        _cut(stem, torque_columns(layout, signals, layout.limb(limb)), rows, out.parent / estimate_place(method))
    for place, path in copied.items():
        copy(path, out.parent / place)
    for name, path in detections.items():
        kept = _rows_of(settings, collision, name, path)
        write_text(out.with_name(f"{name}.csv"), csv_text(columns_of(name), map(astuple, kept)))
    arrays = {RECORDING: recording, **{estimate_place(method): stem for method, stem in estimates.items()}}
    read = {f"{name}{ARRAY}": file_of(stem, ARRAY) for name, stem in arrays.items()} | {**copied}
    read |= {f"{name}.csv": path for name, path in detections.items()}
    sources = {name: _source(path) for name, path in read.items()}
    cut = {"from_row": rows.start, "to_row": rows.stop, **provenance()}
    # The description comes last: whoever finds it finds every file that it lists.
    write_json(out, {"scale": scale, "sources": sources, "cut": cut})
    log.info("%s: %s, %d rows", out, settings.push, rows.stop - rows.start)


def copy(path: Path, out: Path) -> None:
    """Copy a file atomically; a DataError says that it is missing."""
    if not path.is_file():
        raise DataError(f"{path}: file is missing")
    with atomic_path(out) as temporary:
        shutil.copyfile(path, temporary)


def copy_demo(made: Path, out: Path) -> None:
    """Copy the folder of the stored push, as its description lists it; what else stands there is removed.

    Raises:
        DataError: a file is missing.
    """
    names = [SOURCES, *files_of(read_json(made / SOURCES))]
    for name in names:
        copy(made / name, out / name)
    for path in out.rglob("*"):
        if path.is_file() and str(path.relative_to(out)) not in names:
            path.unlink()


def files_of(note: Mapping[str, Any]) -> Iterator[str]:
    """Yield the names of the files that a description lists, an array with its note."""
    for name in note["sources"]:
        yield name
        if name.endswith(ARRAY):
            yield name.removesuffix(ARRAY) + NOTE


def _collision(settings: Story, limb: str, seed: int, path: Path) -> Collision:
    """Return the first push of its name in the recording of a seed."""
    asked = settings.scenario, seed, limb, settings.push
    rows: list[Collision] = read_detections(path, "collisions")
    found = [row for row in rows if (row.scenario, row.seed, row.leg, row.push) == asked]
    if not found:
        raise DataError(f"{path}: no row of {', '.join(map(str, asked))}; accepted: a recording with this push")
    return found[0]


def _window(settings: Story, pushes: Sequence[str], recording: Path) -> slice:
    """Return the rows around the push in the recording."""
    array, note = read_array(recording, [f"{PUSH}.row"])
    segments, rate_hz = spans_and_rate(note)
    start = int((array[:, 0] == 1 + pushes.index(settings.push)).argmax())
    rows = slice(start - round(settings.before_s * rate_hz), start + round(settings.after_s * rate_hz))
    if not any(first <= rows.start and rows.stop <= last for first, last in segments):
        accepted = f"rows {rows.start} to {rows.stop} in one segment, the time around {settings.push}"
        raise DataError(f"{recording}{NOTE}: {not_accepted('segments', note['segments'], [accepted])}")
    return rows


def _cut(stem: Path, columns: Sequence[tuple[str, str, str]], rows: slice, out: Path) -> None:
    """Write some rows of columns of an array, with what its note says."""
    array, note = read_array(stem, [name for name, _, _ in columns])
    write_array(out, array[rows], columns, {key: value for key, value in note.items() if key not in OWN})


def _rows_of(settings: Story, collision: Collision, name: str, path: Path) -> list[Any]:
    """Return the rows of a file of detectors that are about the push and the detector, thresholds of its only rule."""
    if name == "collisions":
        return [collision]
    asked = {"leg": collision.leg, "detector": settings.detector, "kind": COLLISION}
    if name == "detected":
        asked |= {"scenario": collision.scenario, "seed": collision.seed, "number": collision.number}
    found: list[Any] = []
    for row in read_detections(path, name):
        if all(getattr(row, key) == value for key, value in asked.items()):
            found.append(row)
    return found


def _source(path: Path) -> dict[str, str]:
    """Return a file of a run with its hash and, where its note tells it, the commit that made it."""
    note = path.with_suffix(NOTE) if path.suffix == ARRAY else path.parent / "run.json"
    made = read_json(note).get("provenance", {}) if note.is_file() else {}
    return {"file": str(path), "sha256": file_hash(path), **({"commit": made["commit"]} if "commit" in made else {})}

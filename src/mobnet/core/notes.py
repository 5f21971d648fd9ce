"""Notes: JSON files that say what stands beside them. A kind of note is a class, its fields are the accepted keys."""

import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Annotated, Any, TypeVar

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, ValidationError

from mobnet.core.errors import SHOWN, not_accepted, refusal, refuse
from mobnet.core.files import read_json


class Note(BaseModel):
    """A note; types are not converted, and numbers are finite."""

    # A class is built when it first checks a note: a job imports dozens and needs few.
    model_config = ConfigDict(strict=True, frozen=True, extra="allow", allow_inf_nan=False, defer_build=True)


Kind = TypeVar("Kind", bound=Note)
Item = TypeVar("Item")
Count = Annotated[int, Field(ge=1)]
Index = Annotated[int, Field(ge=0)]
Positive = Annotated[float, Field(gt=0)]
NotNegative = Annotated[float, Field(ge=0)]
Text = Annotated[str, Field(min_length=1)]
# What becomes the name of a file or a folder: never another place, whoever wrote the note.
FileName = Annotated[str, Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9_.-]*$", max_length=100)]


def _distinct(names: list[Item]) -> list[Item]:
    """Check that no item occurs twice."""
    name, count = Counter(names).most_common(1)[0]
    if count > 1:
        raise ValueError(f"{name!r} occurs {count} times; accepted: once")
    return names


Names = Annotated[list[Text], Field(min_length=1), AfterValidator(_distinct)]


class NotedColumn(Note):
    """A column as the note of an array has it."""

    name: Text
    unit: Text
    frame: Text


class ArrayNote(Note):
    """The note of an array, of which `rows`, `segments`, `rate_hz` and `columns` must be there.

    Segments (start, end) are contiguous in time, in order and disjoint. The other keys are those that the simulator,
    the observer and estimators add; `terrains` has one for each segment, `std_scale` is joint -> factor, `recording` is
    the hash of the footer of the recording that an estimate was made of.
    """

    rows: Count
    segments: Annotated[list[Annotated[list[Index], Field(min_length=2, max_length=2)]], Field(min_length=1)]
    rate_hz: Positive
    columns: Annotated[list[NotedColumn], Field(min_length=1)]
    scenario: Text = "-"
    level: Text = "-"
    seed: Index = 0
    falls: Index = 0
    terrains: list[Text] = []
    clearance_min_m: Annotated[float, Field(ge=-1, le=5)] = 0.0
    self_collisions: Index = 0
    provenance: dict[str, Text] = {}
    gain_hz: Positive = 1.0
    nominal_mass_ratio: Positive = 1.0
    method: Text = "-"
    networks: dict[str, Text] = {}
    std_scale: dict[str, Positive] = {}
    footer: Text = "-"
    recording: Text = "-"


def read_array_note(path: Path) -> dict[str, Any]:
    """Read the note of an array, as it is written.

    Raises:
        DataError: the file is missing or damaged, or a key or a value is not accepted; one line for each.
    """
    note = read_json(path)
    check_array_note(path, note)
    return note


def check_array_note(path: Path, note: Mapping[str, Any]) -> None:
    """Raise a DataError with one line for each key or value of an array's note that is not accepted."""
    refuse(path, _array_faults(checked(path, note, ArrayNote)))


def read_note(path: Path, kind: type[Kind]) -> Kind:
    """Read a note of a kind.

    Raises:
        DataError: the file is missing or damaged, or a key or a value is not accepted; one line for each.
    """
    return checked(path, read_json(path), kind)


def checked(path: Path, value: object, kind: type[Kind]) -> Kind:
    """Return a note of a kind with these values.

    Raises:
        DataError: a key or a value is not accepted; one line for each.
    """
    try:
        return kind.model_validate(value)
    except ValidationError as error:
        raise refusal(path, [fault_of(error_found, kind) for error_found in error.errors(include_url=False)]) from None


def fault_of(details: Mapping[str, Any], kind: type[Note]) -> str:
    """Return what pydantic found as a line: key, value, accepted values."""
    place = ".".join(map(str, details["loc"])) or "top level"
    if details["type"] == "missing":
        needed = ", ".join(name for name, field in kind.model_fields.items() if field.is_required())
        return f"{place}: key is missing; accepted: {details['loc'][-1] if '.' in place else needed}"
    if details["type"] == "extra_forbidden":
        return not_accepted(place, details["input"], [f"no such key, but {', '.join(kind.model_fields)}"])
    if details["type"] == "value_error":
        return f"{place}: {details['ctx']['error']}"
    if details["type"] == "string_pattern_mismatch":
        return not_accepted(place, details["input"], [f"text of the form {details['ctx']['pattern']}"])
    what = re.sub(r"^\w+ should (be|have) ", "", details["msg"])
    what = re.sub(r"a valid dictionary( or instance of \w+)?", "a JSON object", what)
    return not_accepted(place, details["input"], [what[:1].lower() + what[1:]])


def _array_faults(note: ArrayNote) -> Iterator[str]:
    """Yield what does not fit together in an array's note."""
    for name, count in Counter(column.name for column in note.columns).items():
        if count > 1:
            yield f"columns: {name!r} occurs {count} times; accepted: once"
    yield from segment_faults(note.segments, note.rows)
    if note.terrains and len(note.terrains) != len(note.segments):
        yield not_accepted("terrains", note.terrains, [f"one for each of {len(note.segments)} segments"])


def segment_faults(segments: Sequence[Sequence[int]], rows: int) -> Iterator[str]:
    """Yield segments (start, end) that are empty, lie outside of the rows, or not behind the one before."""
    for index, (start, end) in enumerate(segments):
        if not 0 <= start < end <= rows:
            accepted = f"start and end with 0 <= start < end <= {rows} rows"
            yield not_accepted(f"segments.{index}", [start, end], [accepted])
    for index, (before, after) in enumerate(pairwise(segments), start=1):
        if after[0] < before[1]:
            accepted = f"a start at or after {before[1]}, the end of the one before"
            yield not_accepted(f"segments.{index}", list(after), [accepted])


def note_differences(note: Mapping[str, Any], other: Mapping[str, Any], name: str) -> Iterator[str]:
    """Yield in what the note of an array differs from that of another, which is of the same samples and has a name."""
    for key in ("rows", "segments", "rate_hz", "scenario", "level", "seed"):
        if note.get(key) != other.get(key) and key in note and key in other:
            yield not_accepted(key, note[key], [f"{SHOWN.repr(other[key])}, as in {name}"])


def pair_differences(note: Mapping[str, Any], recording: Mapping[str, Any], name: str) -> Iterator[str]:
    """Yield in what the note of an array differs from that of its recording, which has a name.

    Another recording of the same length is noticed where the note says which one it belongs to.
    """
    yield from note_differences(note, recording, name)
    if "recording" in note and note["recording"] != recording.get("footer", note["recording"]):
        accepted = (
            f"{recording['footer']}, the footer in {name}: the recording that it was made of; observe the log anew"
        )
        yield not_accepted("recording", note["recording"], [accepted])

"""Logs that are text with a separator: how a file is laid out, which its first lines tell, and its columns."""

import codecs
import csv
import gzip
import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain
from pathlib import Path
from typing import IO, Any, cast

import numpy as np
from numpy.typing import NDArray

from mobnet.core.errors import SHOWN, DataError
from mobnet.robotlog.columns import LogColumn, check_memory

SECONDS = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9}  # in a unit of Arrow's times
LOOKED_BYTES = 2**20  # of a file in which its layout is looked for
LOOKED_ROWS = 100  # in which a decimal comma is looked for
FIRST_BYTES = 4 * 2**20  # in which the kinds of columns are looked for
BLOCK_BYTES = 2**20  # that are read together
SPACES = ""  # in place of a separator: any number of spaces
SEPARATORS = (";", "\t", ",", SPACES)  # in the order tried: a comma may stand in numbers, a space in names
COMMENTS = ("#", "%", "//", "sep=")  # first characters of lines that are no rows
ENCODINGS = {codecs.BOM_UTF8: "utf-8-sig", codecs.BOM_UTF16_LE: "utf-16", codecs.BOM_UTF16_BE: "utf-16"}
PACKED = ".gz"  # last ending of a text that gzip has packed
LABVIEW = "LabVIEW Measurement"  # first words of a text of LabVIEW, whose
LABVIEW_HEADERS, END_OF_HEADER = 2, "***End_of_Header***"  # headers, that of the file and that of the rows, end so
LABVIEW_COMMENT = "Comment"  # the last name there, of fields that most rows do not have
# What programs write in a cell that has no number, without regard to case; some of them are of Excel, pandas, Python or
# Microsoft's C.
MISSING = (
    *(
        "",
        "n/a",
        "na",
        "#n/a",
        "#n/a n/a",
        "#na",
        "<na>",
        "none",
        "null",
        "nil",
        "nan",
        "-nan",
        "nan(ind)",
        "-nan(ind)",
    ),
    *(
        "nan(snan)",
        "-nan(snan)",
        "1.#ind",
        "-1.#ind",
        "1.#qnan",
        "-1.#qnan",
        "1.#snan",
        "-1.#snan",
        "1.#inf",
        "-1.#inf",
    ),
)
DECIMAL_COMMA = re.compile(r"[+-]?\d*,\d+([eE][+-]?\d+)?")


def is_numeric(kind: Any) -> bool:
    """Return whether a column of this type of Arrow holds numbers, points in time, times of day or durations."""
    from pyarrow import types

    tests = types.is_floating, types.is_integer, types.is_boolean, types.is_decimal, _is_time
    return any(test(kind) for test in tests)


def _is_time(kind: Any) -> bool:
    """Return whether a type of Arrow is one of times with a unit."""
    from pyarrow import types

    return types.is_timestamp(kind) or types.is_duration(kind) or types.is_time(kind)


def numbers(column: Any) -> NDArray[Any]:
    """Return a column as floating numbers, NaN where it has none; times become seconds, points in time since 1970.

    Arrow's own conversion would import pandas.
    """
    import pyarrow as pa
    import pyarrow.compute as pc

    size = 1.0
    if _is_time(column.type):
        size = SECONDS[column.type.unit]
        whole = pa.int32() if pa.types.is_time32(column.type) else pa.int64()
        column = pc.cast(column, whole)
    if column.type not in (pa.float32(), pa.float64()):
        column = pc.cast(column, pa.float64(), safe=False)
    values: NDArray[Any] = np.from_dlpack(column.fill_null(np.nan) if column.null_count else column)
    return values * size if size != 1.0 else values


@dataclass(frozen=True)
class Layout:
    """How a text is laid out.

    Attributes:
        fields: number of fields in a row.
        places: name -> the columns that have it in the header; where there is none, names are their numbers, from 0.
        separator: what stands between two fields, `SPACES` for any number of spaces.
        decimal: what stands before the fraction of a number, a point or a comma.
        encoding: of its characters.
        lead: lines before the first row.
    """

    fields: int
    places: Mapping[str, Sequence[int]]
    separator: str
    decimal: str
    encoding: str
    lead: int


def csv_names(path: Path) -> list[str]:
    """Return the columns of a text with a separator: those in its header, or their numbers where it has none."""
    layout = _layout(path)
    return list(layout.places) if layout else []


def has_header(names: Collection[str]) -> bool:
    """Return whether names are more than the numbers of columns."""
    return [*names] != [str(k) for k in range(len(names))]


def refuse_without_header(path: Path, names: Collection[str]) -> None:
    """Raise a DataError where a log without a map has no header either, with its first row."""
    if not has_header(names):
        row = next(line for line in _first_lines(path)[1] if not _is_left_out(line))
        accepted = f'a header, or a map that names columns by number, "0" to "{len(names) - 1}"'
        raise DataError(f"{path}: has no header; its first row is {SHOWN.repr(row)}; accepted: {accepted}")


def csv_columns(path: Path, wanted: Collection[str]) -> dict[str, LogColumn]:
    """Read columns of a text with a separator; a field without a number is NaN.

    Raises:
        DataError: several columns have a name that is wanted.
    """
    layout = _layout(path)
    if layout is None:
        return {}
    places = dict[str, int]()
    for name, columns in layout.places.items():
        if name not in wanted:
            continue
        if len(columns) > 1:
            times = "twice" if len(columns) == 2 else f"{len(columns)} times"
            accepted = "one column of that name; give the others other names"
            raise DataError(f"{path}: column {name!r} stands {times} in the header; accepted: {accepted}")
        places[name] = columns[0]
    most = _most_rows(path)
    check_memory(path, most, len(places))
    read = _spaced(path, layout, places) if layout.separator == SPACES else _separated(path, layout, places, most)
    return {name: read[place] for name, place in places.items()}


def _layout(path: Path) -> Layout | None:
    """Return how a text is laid out, None if no line has numbers.

    Raises:
        DataError: it is empty or no text, or has a header alone.
    """
    encoding, lines = _first_lines(path)
    top = _end_of_labview(lines)
    for separator in SEPARATORS:
        rows = [_fields(line, separator) for line in lines]
        first = next((k for k in range(top, len(lines)) if _begins(lines, rows, k)), None)
        if first is not None:
            break
    else:
        if len([line for line in lines if not _is_left_out(line)]) < 2:
            looked = f" in its first {LOOKED_BYTES} bytes" if path.stat().st_size > LOOKED_BYTES else ""
            raise DataError(f"{path}: has no row below its header{looked}; accepted: a log with two samples or more")
        return None
    places = _header(lines[top:first], rows[top:first], rows[first], separator)
    looked = list(chain.from_iterable(rows[first : first + LOOKED_ROWS]))
    # A comma is a decimal sign only where it separates no fields, and where no number has a point.
    has_comma = separator != "," and any(DECIMAL_COMMA.fullmatch(field) for field in looked)
    decimal = "," if has_comma and not any("." in field for field in looked) else "."
    return Layout(len(rows[first]), places, separator, decimal, encoding, first)


def _end_of_labview(lines: Sequence[str]) -> int:
    """Return the number of the lines that are headers of LabVIEW; they hold numbers, such as those of the samples."""
    if not lines[0].startswith(LABVIEW):
        return 0
    ends = [k + 1 for k, line in enumerate(lines) if line.startswith(END_OF_HEADER)]
    return ends[:LABVIEW_HEADERS][-1] if ends else 0


def _header(
    lines: Sequence[str], rows: Sequence[Sequence[str]], first: Sequence[str], separator: str
) -> dict[str, list[int]]:
    """Return the columns of each name in the header above the first row; their numbers without one.

    A header may be a comment: its first name then counts with the sign before it, too, as `%time` of rostopic.
    """
    for line, row in zip(lines, rows, strict=True):
        names = _named(row or _fields(line.lstrip("#%/ "), separator), first)
        if not names:
            continue
        places = dict[str, list[int]]()
        for k, name in enumerate(names):
            if name:
                places.setdefault(name, []).append(k)
        with_sign = line.split(separator or None)[0].strip()
        if not row and with_sign.lstrip("#%/ ") == names[0]:
            places.setdefault(with_sign, [0])
        return places
    return {str(k): [k] for k in range(len(first))}


def opened_text(path: Path) -> IO[bytes]:
    """Open a text for its bytes, one that is packed for those that it had before."""
    return cast(IO[bytes], gzip.open(path)) if path.suffix.lower() == PACKED else path.open("rb")


def _first_lines(path: Path) -> tuple[str, list[str]]:
    """Return the encoding of a text, and its first lines."""
    with opened_text(path) as file:
        start = file.read(LOOKED_BYTES)
    encoding = next((name for mark, name in ENCODINGS.items() if start.startswith(mark)), "utf-8")
    # In UTF-16 every second byte of plain letters is zero; elsewhere a zero byte says that the file is no text.
    if encoding != "utf-16" and b"\0" in start:
        raise DataError(f"{path}: byte {start.index(0)} is zero, which no text has; accepted: text in UTF-8 or UTF-16")
    try:
        text = codecs.getincrementaldecoder(encoding)().decode(start)
    except UnicodeDecodeError:
        encoding = "cp1252"  # of Windows, where it is not UTF-8
        text = start.decode(encoding, errors="replace")
    lines = text.splitlines()
    if len(start) == LOOKED_BYTES and len(lines) > 1:
        del lines[-1]  # which may go on
    if not text.strip():
        raise DataError(f"{path}: is empty; accepted: a log with two samples or more")
    return encoding, lines


def _is_left_out(line: str) -> bool:
    """Return whether a line is empty or a comment."""
    return not line.strip() or line.lstrip().startswith(COMMENTS)


def _fields(line: str, separator: str) -> list[str]:
    """Return the fields of a line, none of one that is left out."""
    if _is_left_out(line):
        return []
    if separator == SPACES:
        return line.split()
    quoted = csv.reader([line], delimiter=separator, skipinitialspace=True) if '"' in line else [line.split(separator)]
    return [field.strip() for field in next(iter(quoted))]


def _begins(lines: Sequence[str], rows: Sequence[Sequence[str]], first: int) -> bool:
    """Return whether the rows of numbers begin at a line: it and the next one have as many fields, mostly numbers."""
    row = rows[first]
    filled = [field for field in row if field]
    if len(row) < 2 or not filled or 2 * sum(map(_is_number, filled)) < len(filled):
        return False
    after = next((rows[k] for k in range(first + 1, len(lines)) if not _is_left_out(lines[k])), row)
    if any(_is_number(below) and not _is_number(field) for field, below in zip(row, after, strict=False) if field):
        return False  # a header, in which numbers are names
    return len(after) == len(row) or first + 2 >= len(lines)


def _is_number(field: str) -> bool:
    """Return whether a field is a number, with a point or a comma, or stands for one that is missing."""
    if field.lower() in MISSING:
        return True
    try:
        float(field.replace(",", "."))
    except ValueError:
        return False
    return True


def _named(fields: Sequence[str], row: Sequence[str]) -> list[str]:
    """Return the names of columns that a line above a row gives, none if it is no header.

    A separator at the end of the header or of the row stands before nothing, and so does LabVIEW's name of comments.
    """
    names = list(fields)
    if len(names) == len(row) + 1 and names[-1] in ("", LABVIEW_COMMENT):
        names.pop()
    if len(names) == len(row) - 1 and not row[-1]:
        names.append("")
    is_header = len(names) == len(row) and any(name and not _is_number(name) for name in names)
    return names if is_header else []


def _separated(path: Path, layout: Layout, places: Mapping[str, int], most: int) -> dict[int, LogColumn]:
    """Read columns of a text of at most so many rows by Arrow; rows with another number of fields are left out."""
    import pyarrow as pa
    from pyarrow import csv as arrow

    wrong = list[int]()

    def leave_out(row: arrow.InvalidRow) -> str:
        wrong.append(row.actual_columns)
        return "skip"

    parse = arrow.ParseOptions(delimiter=layout.separator, invalid_row_handler=leave_out)
    read = arrow.ReadOptions(
        column_names=[str(k) for k in range(layout.fields)],  # those in the header may stand there twice
        skip_rows=layout.lead,
        block_size=FIRST_BYTES,
        encoding=layout.encoding,
        use_threads=False,
    )
    asked = [str(place) for place in sorted(set(places.values()))]
    kept = {"include_columns": asked, "null_values": _missing_words(), "decimal_point": layout.decimal}
    # Of an open file, as Arrow takes no name that is not UTF-8.
    with opened_text(path) as text, arrow.open_csv(text, read, parse, arrow.ConvertOptions(**kept)) as file:
        first = file.schema  # of the first block: what looks whole there, or empty, may be a fraction further down
    # Columns of a stated type are read in two thirds of the time of those whose type Arrow looks for.
    kinds = {f.name: pa.float64() if _is_loose(f.type) else f.type for f in first}
    # The rows of the first block were counted already, and are read again.
    wrong.clear()
    read.block_size = BLOCK_BYTES
    converted = arrow.ConvertOptions(**kept, column_types=kinds)
    with opened_text(path) as text, arrow.open_csv(text, read, parse, converted) as file:
        numeric = [k for k, kind in enumerate(file.schema.types) if is_numeric(kind)]
        texts = [k for k in range(len(file.schema)) if k not in numeric]
        values = [np.empty(most) for _ in numeric]
        others = dict[int, str]()
        rows = 0
        for batch in file:
            # Whole columns of Arrow's own reader would take twice the memory.
            for column, k in zip(values, numeric, strict=True):
                column[rows : rows + len(batch)] = numbers(batch.column(k))
            rows += len(batch)
            others = others or {int(asked[k]): _such_as(batch.column(k).to_pylist()) for k in texts}
    hint = " ".join(_left_out(wrong, layout.fields))
    columns = dict[int, LogColumn]()
    for values_of_column, k in zip(values, numeric, strict=True):
        columns[int(asked[k])] = LogColumn(values_of_column[:rows], hint=hint)
    return columns | {place: LogColumn(np.empty(0), found=text) for place, text in others.items()}


def _missing_words() -> list[str]:
    """Return all that stands for a missing number, as Arrow wants it: in each case, and with a space beside it."""
    cased = dict.fromkeys([*MISSING, *map(str.upper, MISSING), *map(str.capitalize, MISSING), "NaN", "-NaN"])
    return [*cased, *(f" {word}" for word in cased), *(f"{word} " for word in cased if word)]


def _is_loose(kind: Any) -> bool:
    """Return whether a column of a type of Arrow, that of its first rows, may hold other numbers further down."""
    from pyarrow import types

    return types.is_integer(kind) or types.is_null(kind)


def _most_rows(path: Path) -> int:
    """Return how many rows a text has at most: a column has that much room, of which the system gives what is used."""
    most = 1
    with opened_text(path) as file:
        while block := file.read(BLOCK_BYTES):
            most += block.count(b"\n") + block.count(b"\r") - block.count(b"\r\n")
    return most


def _left_out(wrong: Sequence[int], fields: int) -> Iterator[str]:
    """Yield the hint on rows with another number of fields, which are left out."""
    if wrong:
        rows = f"{len(wrong)} row{'s' * (len(wrong) > 1)} left out, with {wrong[0]} fields in place of {fields}"
        yield f"{rows}; the last row may be cut"


def _such_as(values: Sequence[Any]) -> str:
    """Return what a column of texts holds, by the first that is no number."""
    texts = ((row, value) for row, value in enumerate(values) if value is not None and not _is_number(str(value)))
    row, value = next(texts, (0, values[0]))
    return f"text, {str(value)!r} in row {row}"


def _spaced(path: Path, layout: Layout, places: Mapping[str, int]) -> dict[int, LogColumn]:
    """Read columns with any number of spaces between them, which Arrow cannot."""
    import pandas as pd

    frame = pd.read_csv(
        path,
        sep=r"\s+",
        header=None,
        names=list(range(layout.fields)),
        usecols=sorted(set(places.values())),
        skiprows=layout.lead,
        decimal=layout.decimal,
        encoding=layout.encoding,
        na_values=_missing_words(),
        on_bad_lines="skip",
    )
    # A log that ends early may end in a short row, which pandas would fill with NaN.
    last = _fields(_last_line(path, layout.encoding), SPACES)
    is_cut = len(last) != layout.fields
    frame = frame.iloc[:-1] if is_cut else frame
    hint = " ".join(_left_out([len(last)] if is_cut else [], layout.fields))
    columns = dict[int, LogColumn]()
    for place in sorted(set(places.values())):
        kind = frame[place].dtype.kind
        is_text = kind not in "fiub"
        values = np.empty(0) if is_text else frame[place].to_numpy(np.float64)
        columns[place] = LogColumn(values, hint=hint, found=_such_as(list(frame[place])) if is_text else "")
    return columns


def _last_line(path: Path, encoding: str) -> str:
    """Return the last line of a text."""
    with opened_text(path) as file:
        end = b""
        while block := file.read(LOOKED_BYTES // 2):
            end = end[-LOOKED_BYTES // 2 :] + block
    return end.decode(encoding.removesuffix("-sig"), errors="replace").rstrip().splitlines()[-1]

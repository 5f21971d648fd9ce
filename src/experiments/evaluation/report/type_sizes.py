"""How large the type of each figure is in print: as it was drawn, times the factor by which TeX printed the figure.

Both are read from what is printed, so that neither can be forgotten: sizes from the figure's PDF, which selects a font
and a size before each text, and the printed width from TeX's log. Every letter counts, those of subscripts and powers,
too. One point is 1/72 inch, as in a PDF; TeX's is 1/72.27 inch.
"""

import re
import zlib
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

from mobnet.core.errors import DataError

TEX_POINTS = 72.27 / 72  # of TeX in one of a PDF
PRINTED = re.compile(  # by the package graphics, whose lines TeX's log holds unbroken
    r"Package pdftex\.def Info: (?P<path>\S+\.pdf)\s+used on input line \d+\.\s+"
    r"\(pdftex\.def\)\s+Requested size: (?P<width>[\d.]+)pt x (?P<height>[\d.]+)pt\."
)
BOX = re.compile(rb"/MediaBox \[ ?(?P<left>[-\d.]+) [-\d.]+ (?P<right>[-\d.]+) [-\d.]+ ?\]")
STREAM = re.compile(rb"stream\r?\n(?P<data>.*?)\r?\nendstream", re.DOTALL)
SIZE = re.compile(rb"/F\d+(?:-\d+)? (?P<size>[\d.]+) Tf\b")  # a font and the size of the text after it


@dataclass(frozen=True)
class PrintedType:
    """The smallest type of a figure.

    Attributes:
        name: of the figure's file, without its ending.
        native_pt: size of the type as drawn [points].
        factor: printed over native width [-].
    """

    name: str
    native_pt: float
    factor: float

    @property
    def printed_pt(self) -> float:
        """The size in print [points]."""
        return self.native_pt * self.factor


def printed_widths(log: str) -> dict[str, float]:
    """Return figure's path -> the width at which TeX printed it, the smallest one of several [points]."""
    widths: dict[str, float] = {}
    for found in PRINTED.finditer(log):
        width = float(found["width"]) / TEX_POINTS
        widths[found["path"]] = min(width, widths.get(found["path"], width))
    return widths


def width_of(pdf: bytes) -> float:
    """Return the width of a PDF's page [points].

    Raises:
        ValueError: there is none.
    """
    box = BOX.search(pdf)
    if box is None:
        raise ValueError("no page with a size")
    return float(box["right"]) - float(box["left"])


def type_sizes(pdf: bytes) -> set[float]:
    """Return the sizes of the type that a PDF selects [points], none where it has no text."""
    return {float(found["size"]) for page in _streams(pdf) for found in SIZE.finditer(page)}


def _streams(pdf: bytes) -> Iterator[bytes]:
    """Yield the streams of a PDF as they were before they were packed."""
    for found in STREAM.finditer(pdf):
        try:
            yield zlib.decompress(found["data"])
        except zlib.error:  # a stream that is not packed
            yield found["data"]


def printed_types(log: str, folder: Path) -> list[PrintedType]:
    """Return the smallest type of each figure with text that TeX's log names, the smallest in print first.

    Paths of the log are relative to `folder`.

    Raises:
        DataError: a figure has no page.
    """
    found: list[PrintedType] = []
    for path, width in printed_widths(log).items():
        pdf = (folder / path).read_bytes()
        try:
            factor = width / width_of(pdf)
        except ValueError as error:
            raise DataError(f"{path}: {error}") from error
        if sizes := type_sizes(pdf):
            found.append(PrintedType(Path(path).stem, min(sizes), factor))
    return sorted(found, key=lambda one: one.printed_pt)


def type_faults(types: Iterable[PrintedType], least_pt: float) -> list[str]:
    """Return a line for each figure whose smallest type in print is below `least_pt` [points]."""
    remedy = "draw it less high or with larger type, or give it more room in main.tex"
    small = [one for one in types if round(one.printed_pt, 2) < least_pt]
    return [
        f"{one.name}: smallest type in print {one.printed_pt:.2f} pt, drawn at {one.native_pt:g} pt and printed at "
        f"{one.factor:.3f} of its size; accepted: {least_pt:g} pt, so {remedy}"
        for one in small
    ]

"""Which link a collision hits and from where, as detectors name it at their alarm: a confusion matrix."""

from collections.abc import Sequence
from pathlib import Path

from experiments.evaluation.measure.detection.results import ALL, CELLS, Detections, share_of, shown_tries
from experiments.evaluation.number.files import Field
from experiments.evaluation.tables.layout import Line, Table, in_blocks, write_table
from experiments.settings.detection_tables import Links
from experiments.settings.runs import Statistics
from mobnet.core.columns import DETECTION
from mobnet.settings.detection import Detection

NAMED = "named"
RIGHT_LINK = "right_link"
RIGHT_CELL = "right_cell"


def links(
    settings: Links, detection: Detection, statistics: Statistics, detections: Detections, table_dir: Path
) -> None:  # fmt: skip
    """Write links.csv, .tex and .md: collisions that are found, by what they hit and what the detector names.

    The last columns are the shares of those whose link, and whose link and direction, it names [-].
    """
    rows: list[Sequence[Field]] = []
    blocks: list[tuple[list[str], list[list[str]]]] = []
    for level, tries in shown_tries(settings, detections, detection.collisions, settings.kind):
        for name, whole in tries.items():
            lines: list[list[str]] = []
            for cell in (*CELLS, ALL):
                own = [one for one in whole if cell in (one.cell, ALL) and one.is_found]
                named = [one.named for one in own]
                place = level, name, settings.leg, settings.kind, cell
                counts: list[str] = []
                for other in CELLS:
                    count = named.count(other)
                    counts.append(str(count))
                    rows.append((*place, f"{NAMED} {other}", count, None, None, len(own), "-", None))
                right = {
                    RIGHT_LINK: share_of(own, lambda one: one.detected.link == one.collision.link, statistics),
                    RIGHT_CELL: share_of(own, lambda one: one.named == one.cell, statistics),
                }
                rows += [(*place, key, *number.with_ends, len(own), "-", None) for key, number in right.items()]
                shares = [number.text() for number in right.values()]
                lines.append([cell, *counts, *shares, right[RIGHT_LINK].interval()])
            blocks.append(([level.replace("_", " "), name], lines))
    header = ["Level", "Detector", "Hit", *CELLS, "link", "link and side", f"{statistics.confidence:.0%} (link)"]
    found: list[Line] = in_blocks(blocks)
    write_table(table_dir / "links", Table(DETECTION, rows, header, found, left=3))

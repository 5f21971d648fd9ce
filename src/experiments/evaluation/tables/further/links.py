"""Which link a collision hits and from where, as detectors name it at their alarm: a confusion matrix."""

from pathlib import Path

from experiments.evaluation.measure.detection.results import ALL, CELLS, Detections, share_of, shown_tries
from experiments.evaluation.number.number import Number
from experiments.evaluation.tables.rows import Rows, View, ViewColumn, interval
from experiments.settings.detection_tables import Links
from experiments.settings.runs import Statistics
from mobnet.core.columns import DETECTION
from mobnet.settings.detection import Detection

NAMED = "named"
RIGHT_LINK = "right_link"
RIGHT_CELL = "right_cell"


def links(
    settings: Links, detection: Detection, statistics: Statistics, detections: Detections, table_dir: Path
) -> None:
    """Write links.csv, .tex and .md: collisions that are found, by what they hit and what the detector names.

    The last columns are the shares of those whose link, and whose link and direction, it names [-].
    """
    rows = Rows(DETECTION)
    for level, tries in shown_tries(settings, detections, detection.collisions, settings.kind):
        for name, whole in tries.items():
            for cell in (*CELLS, ALL):
                own = [one for one in whole if cell in (one.cell, ALL) and one.is_found]
                place = {"level": level, "detector": name, "leg": settings.leg, "kind": settings.kind, "cell": cell}
                for other in CELLS:
                    count = sum(one.named == other for one in own)
                    rows.add(Number(count), **place, quantity=f"{NAMED} {other}", count=len(own))
                link = share_of(own, lambda one: one.detected.link == one.collision.link, statistics)
                both = share_of(own, lambda one: one.named == one.cell, statistics)
                rows.add(link, **place, quantity=RIGHT_LINK, count=len(own))
                rows.add(both, **place, quantity=RIGHT_CELL, count=len(own))
    counts = [ViewColumn(cell, {"quantity": f"{NAMED} {cell}"}, digits=0) for cell in CELLS]
    link = {"quantity": RIGHT_LINK}
    share = f"{statistics.confidence:.0%} (link)"
    shares = [
        ViewColumn("link", link),
        ViewColumn("link and side", {"quantity": RIGHT_CELL}),
        ViewColumn(share, link, text=interval),
    ]
    labels = {"level": "Level", "detector": "Detector", "cell": "Hit"}
    rows.write(table_dir / "links", View(labels, [*counts, *shares], blocks=("level", "detector")))

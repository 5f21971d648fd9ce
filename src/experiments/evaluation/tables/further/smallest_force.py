"""The smallest force that detectors find, by what is hit from where."""

from itertools import product
from pathlib import Path

import numpy as np

from experiments.evaluation.measure.detection.results import CELLS, Detections, Try, force_text, shown_tries
from experiments.evaluation.measure.detection.results import smallest_force as force_of
from experiments.evaluation.number.number import Number
from experiments.evaluation.tables.rows import Rows, View, ViewColumn
from experiments.settings.detection_tables import SmallestForce
from experiments.settings.runs import Statistics
from mobnet.core.columns import DETECTION
from mobnet.settings.detection import Detection

QUANTITY = "smallest_force"


def smallest_force(
    settings: SmallestForce, detection: Detection, statistics: Statistics, detections: Detections, table_dir: Path
) -> None:
    """Write smallest_force.csv, .tex and .md: the largest force [N] that a collision must have to be found.

    It is that of which the share of section `smallest_force` is found, by detector, rule of thresholds and cell.
    """
    rows = Rows(DETECTION)
    # read kind by kind, shown level by level
    shown: dict[tuple[str, str], dict[str, list[Try]]] = {}
    for kind in settings.kinds:
        for level, tries in shown_tries(settings, detections, detection.sweep, kind):
            shown[level, kind] = tries
    for level, kind in product(settings.levels, settings.kinds):
        for name, tries in shown[level, kind].items():
            for cell in CELLS:
                own = [one for one in tries if one.cell == cell]
                force = np.array([one.collision.force_n for one in own])
                found = np.array([one.is_found for one in own], dtype=np.float64)
                number = force_of(force, found, settings, statistics) if own else Number(None, unit="N")
                place = {"level": level, "detector": name, "leg": settings.leg, "kind": kind, "cell": cell}
                rows.add(number, **place, quantity=QUANTITY, count=len(own))
    columns = [ViewColumn(f"{cell} [N]", {"cell": cell}, text=lambda row: force_text(row.number)) for cell in CELLS]
    labels = {"level": "Level", "kind": "Rule", "detector": "Detector"}
    rows.write(table_dir / "smallest_force", View(labels, columns, blocks=("level", "kind"), nested=True))

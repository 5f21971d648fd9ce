"""Table 13: thresholds of a leg's joints by the paper's rule, for each detector."""

from collections import defaultdict
from collections.abc import Sequence
from itertools import product
from pathlib import Path
from statistics import geometric_mean

from experiments.evaluation.measure.detection.results import Detections, owners, rows_of
from experiments.evaluation.number.number import number_text, published_row
from experiments.evaluation.number.rows import Field
from experiments.evaluation.tables.layout import OUTSIDE, Table, in_blocks, write_table
from experiments.settings.detection_tables import ThresholdTable
from experiments.settings.published import PublishedTable
from mobnet.core.columns import DETECTION
from mobnet.core.detections import READINGS, Threshold
from mobnet.core.joints import JointLayout
from mobnet.detection.signals import MEAN, RATIO, STD

THRESHOLD = "threshold_nm"  # place of the paper's numbers
QUANTITY = "threshold"


def table_13(
    settings: ThresholdTable, layout: JointLayout, published: PublishedTable, detections: Detections, table_dir: Path
) -> None:
    """Write table_13.csv, .tex and .md: thresholds, means over the robots of a level with the least and the most.

    They are torques [N m], those of a ratio without unit [-], by each reading of the paper's rule; the last column is
    their geometric mean over the paper's. Below those of one detector is its ratio by joint, by the reading that sized
    the robots. The CSV has the thresholds of all detectors of both legs and by all rules.
    """
    rows: list[tuple[Field, ...]] = []
    blocks: list[tuple[list[str], list[list[str]]]] = []
    joints = layout.limb(settings.leg)
    for level in settings.levels:
        names = owners(detections, level, settings.levels)
        found: dict[tuple[str, ...], list[Threshold]] = defaultdict(list)
        for row in rows_of(detections, names, "thresholds", Threshold):
            found[row.detector, row.leg, row.kind, f"{row.signal} {row.phase}"].append(row)
        means: dict[tuple[str, ...], float] = {}
        for key, own in found.items():
            values = [row.value for row in own]
            means[key] = sum(values) / len(values)
            paper = published_row(published, THRESHOLD, key[0]).get(own[0].signal.partition(".")[2])
            is_shown = key[1] == settings.leg and key[2] in settings.kinds
            ends = min(values), max(values), len(values)
            rows.append((level, *key, QUANTITY, means[key], *ends, own[0].unit, paper if is_shown else None))
        lines: list[list[str]] = []
        for name in settings.detectors:
            printed = published_row(published, THRESHOLD, name)
            for place, rule in enumerate(settings.kinds):
                values: list[float] = []
                for joint, kind in product(joints, (MEAN, STD, RATIO)):
                    key = name, settings.leg, rule, f"{kind}.{joint} 1"
                    if key in means:
                        values.append(means[key])
                sizes: list[float] = []
                for ours, joint in zip(values, joints if printed else (), strict=False):
                    if theirs := printed[joint]:
                        sizes.append(ours / theirs)
                texts = [number_text(value) for value in values]
                lines.append([name if place == 0 else "", READINGS.get(rule, rule), *texts, mean_text(sizes)])
                if sizes and (name, rule) == (settings.sized, settings.sized_kind):
                    lines.append(["", "ratio", *(ratio_text(size, settings.ratio) for size in sizes), ""])
            if printed:
                lines.append(["", "original", *(number_text(printed[joint]) for joint in joints), ""])
        blocks.append(([level.replace("_", " ")], lines))
    header = ["Level", "Detector", "", *(f"{joint} [N m]" for joint in joints), "over original"]
    write_table(table_dir / "table_13", Table(DETECTION, rows, header, in_blocks(blocks), left=3))


def mean_text(ratios: Sequence[float]) -> str:
    """Return the geometric mean of ratios [-] as text; a dash where there are none."""
    return number_text(geometric_mean(ratios) if ratios else None)


def ratio_text(ratio: float, bounds: Sequence[float]) -> str:
    """Return the text of a ratio [-], marked where it lies outside of its closed bounds."""
    return number_text(ratio) + ("" if bounds[0] <= ratio <= bounds[1] else OUTSIDE)

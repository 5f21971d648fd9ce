"""Table 13: thresholds of a leg's joints by the paper's rule, for each detector."""

from collections.abc import Sequence
from itertools import product
from pathlib import Path
from statistics import geometric_mean

import pandas as pd

from experiments.evaluation.measure.detection.results import owners
from experiments.evaluation.number.frames import read_detection, records_of
from experiments.evaluation.number.number import number_text, published_row
from experiments.evaluation.tables.layout import OUTSIDE, Table, in_blocks, write_table
from experiments.plan.detection import Detections
from experiments.records.collisions import READINGS
from experiments.settings.detection_tables import ThresholdTable
from experiments.settings.published import PublishedTable
from experiments.settings.table_columns import DETECTION
from mobnet.core.joints import JointLayout
from mobnet.detection.signals import MEAN, RATIO, STD

THRESHOLD = "threshold_nm"  # place of the paper's numbers
QUANTITY = "threshold"
PLACE = ["level", "detector", "leg", "kind", "cell"]  # of a threshold; its cell is signal and phase


def table_13(
    settings: ThresholdTable, layout: JointLayout, published: PublishedTable, detections: Detections, table_dir: Path
) -> None:
    """Write table_13.csv, .tex and .md: thresholds, means over the robots of a level with the least and the most.

    They are torques [N m], those of a ratio without unit [-], by each reading of the paper's rule; the last column is
    their geometric mean over the paper's. Below those of one detector is its ratio by joint, by the reading that sized
    the robots. The CSV has the thresholds of all detectors of both legs and by all rules.
    """
    rows = thresholds_of(settings, published, detections)
    joints = layout.limb(settings.leg)
    signals = [f"{kind}.{joint} 1" for joint, kind in product(joints, (MEAN, STD, RATIO))]
    means = rows[rows["leg"] == settings.leg].set_index(["level", "detector", "kind", "cell"])["value"]
    blocks: list[tuple[list[str], list[list[str]]]] = []
    for level in settings.levels:
        lines: list[list[str]] = []
        for name in settings.detectors:
            printed = published_row(published, THRESHOLD, name)
            for place, rule in enumerate(settings.kinds):
                keys = [(level, name, rule, signal) for signal in signals]
                values = [float(means[key]) for key in keys if key in means.index]
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
    table = Table(DETECTION, records_of(rows, DETECTION), header, in_blocks(blocks), left=3)
    write_table(table_dir / "table_13", table)


def thresholds_of(settings: ThresholdTable, published: PublishedTable, detections: Detections) -> pd.DataFrame:
    """Return the thresholds of all detectors: their mean over the robots of a level, with the least and the most."""
    parts: list[pd.DataFrame] = []
    for level in settings.levels:
        robots = owners(detections, level, settings.levels)
        parts.append(read_detection(detections, robots, "thresholds").assign(level=level))
    thresholds = pd.concat(parts, ignore_index=True)
    thresholds["cell"] = thresholds["signal"] + " " + thresholds["phase"].astype(str)
    groups = thresholds.groupby(PLACE, sort=False)
    rows = groups["value"].agg(["mean", "min", "max", "count"]).reset_index()
    rows = rows.rename(columns={"mean": "value", "min": "low", "max": "high"})
    rows = rows.assign(quantity=QUANTITY, unit=groups["unit"].first().to_numpy())
    printed: list[float | None] = []
    for row in rows.itertuples():
        is_shown = row.leg == settings.leg and row.kind in settings.kinds
        joint = str(row.cell).split(" ")[0].partition(".")[2]
        printed.append(published_row(published, THRESHOLD, str(row.detector)).get(joint) if is_shown else None)
    return rows.assign(published=pd.Series(printed, index=rows.index))


def mean_text(ratios: Sequence[float]) -> str:
    """Return the geometric mean of ratios [-] as text; a dash where there are none."""
    return number_text(geometric_mean(ratios) if ratios else None)


def ratio_text(ratio: float, bounds: Sequence[float]) -> str:
    """Return the text of a ratio [-], marked where it lies outside of its closed bounds."""
    return number_text(ratio) + ("" if bounds[0] <= ratio <= bounds[1] else OUTSIDE)

"""Figure 14: how hard, with what impulse and how long the collisions of a leg are."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure

from experiments.evaluation.figures.style import Look, beside, entitle, legend, looks, save_figure
from experiments.evaluation.measure.detection.results import MS, owners
from experiments.evaluation.number.frames import read_detection, rows_of
from experiments.evaluation.number.rows import Field
from experiments.plan.detection import Detections
from experiments.settings.detection_tables import Figure14
from experiments.settings.published import PublishedCollisions
from mobnet.core.style import styled
from mobnet.settings.detection import Detection

COLUMNS = ("level", "quantity", "bin_from", "bin_to", "count", "mean", "least", "most", "unit", "published")
LABELS = {"largest force": "N", "impulse": "N s", "contact time": "ms"}
HEIGHT_INCH = 2.1
GREY = Look("0.35")


def figure_14(
    settings: Figure14,
    detection: Detection,
    published: PublishedCollisions,
    detections: Detections,
    figure_dir: Path,
) -> None:
    """Write Figure 14 as PDF, SVG, PNG and CSV: histograms of the collisions, those of a level's robots together."""
    printed = {"impulse": published.impulse_ns, "contact time": published.contact_ms}
    by_level = {}
    for level in settings.levels:
        collisions = read_detection(detections, owners(detections, level, settings.levels), "collisions")
        of_leg = rows_of(collisions, scenario=detection.collisions, leg=settings.leg)
        by_level[level.replace("_", " ")] = quantities(of_leg)
    edges: dict[str, np.ndarray] = {}
    for name in LABELS:  # one set of bins for all levels, whose histograms lie over one another
        pooled = np.concatenate([of_level[name] for of_level in by_level.values()])
        edges[name] = np.histogram_bin_edges(pooled, settings.bins)
    rows: list[Sequence[Field]] = []
    for level, of_level in by_level.items():
        for name, unit in LABELS.items():
            counts = np.histogram(of_level[name], edges[name])[0]
            values = of_level[name]
            ends = float(values.mean()), float(values.min()), float(values.max())
            for low, high, count in zip(edges[name], edges[name][1:], counts, strict=False):
                rows.append((level, name, float(low), float(high), int(count), *ends, unit, printed.get(name)))
    save_figure(draw_histograms(by_level, edges, printed), figure_dir / "figure_14", COLUMNS, rows)


def quantities(collisions: pd.DataFrame) -> dict[str, np.ndarray]:
    """Return the largest force [N], the impulse [N s] and the contact time [ms] of collisions (n,)."""
    return {
        "largest force": collisions["force_n"].to_numpy(),
        "impulse": collisions["impulse_ns"].to_numpy(),
        "contact time": (MS * (collisions["end_s"] - collisions["start_s"])).to_numpy(),
    }


@styled
def draw_histograms(
    by_level: Mapping[str, Mapping[str, np.ndarray]], edges: Mapping[str, np.ndarray], printed: Mapping[str, float]
) -> Figure:
    """Draw a panel for each quantity; a dashed line is the paper's mean."""
    styles = dict(zip(by_level, (GREY, *looks(by_level).values()), strict=False))  # colours are those of methods
    figure, axes = beside(len(LABELS), HEIGHT_INCH)
    for k, (axis, (name, unit)) in enumerate(zip(axes, LABELS.items(), strict=True)):
        for level, of_level in by_level.items():
            look = {"facecolor": to_rgba(styles[level].colour, 0.35), "edgecolor": styles[level].colour}
            axis.hist(of_level[name], edges[name].tolist(), histtype="stepfilled", label=level, **look)
        if name in printed:
            axis.axvline(printed[name], label="mean of the original", color="black", linestyle="--", linewidth=0.8)
        axis.set(xlabel=f"{name} [{unit}]", ylabel="collisions")
        entitle(axis, k, name)
    legend(figure, axes)
    return figure

"""Files of detectors of a plant and of a robot with known shares, delays and rates."""

from collections.abc import Mapping, Sequence
from dataclasses import astuple
from pathlib import Path

import numpy as np

from experiments.evaluation.measure.detection.results import CELLS
from experiments.evaluation.number.rows import write_csv
from experiments.records.collisions import UNPUSHED, Collision, CurvePoint, Detected, columns_of
from experiments.settings.settings import Settings
from mobnet.core.detections import CALIBRATION, COLLISION, HELD_OUT, LARGEST, WALKING, FreeSwing, Promise, Threshold

LEVELS = ("all_uncertainty", "robot_1")
FOUND = {"MOB-Net-OR": 1.0, "MOB-Net-sigma": 0.5, "MOB": 0.0}  # detector -> share of the collisions it finds
DELAY_S = {"MOB-Net-OR": 0.020, "MOB-Net-sigma": 0.030, "MOB": 0.040}
# Rule of thresholds -> signal of a collision that is found, over the threshold.
RATIOS = {WALKING: 2.8, LARGEST: 3.0, "contact": 2.5, "bump": 2.2, COLLISION: 2.0, "reaction": 1.8}
EACH, SWINGS = 4, 100  # collisions of a cell, and swings of each part
HOURS, SEED = 0.1, 101
TERRAINS = ("checks", "flat")
Detections = Mapping[str, Mapping[str, Path]]


def on_both_plants(settings: Settings) -> Settings:
    """Return a configuration with detectors on the plant of section 5.1 too, so that both kinds of levels are shown."""
    both = {"levels": ("all_uncertainty", "robots")}
    names = ("table_09", "table_13", "false_alarms", "found_by_rate", "smallest_force", "links", "figure_14")
    shown = {name: getattr(settings.evaluation, name).model_copy(update=both) for name in names}
    whole = {"detection": settings.detection.model_copy(update=both)}
    return settings.model_copy(update={**whole, "evaluation": settings.evaluation.model_copy(update=shown)})


def write_detections(folder: Path, levels: Sequence[str] = LEVELS) -> Detections:
    """Write the files of detectors at some levels, and return them as products get them."""
    found = {}
    for level in levels:
        rows = {
            "collisions": [*collisions("collisions"), *collisions("collision_sweep")],
            "detected": [*detected("collisions"), *detected("collision_sweep")],
            "thresholds": thresholds(),
            "promises": promises(),
            "swings": swings(),
            "curves": curves(),
        }
        found[level] = {name: folder / level / f"{name}.csv" for name in rows}
        for name, own in rows.items():
            write_csv(found[level][name], columns_of(name), [astuple(row) for row in own])
    return found


def collisions(scenario: str) -> list[Collision]:
    """Return four collisions of each cell; forces of a sweep rise from 10 to 80 N."""
    rows = []
    for k, cell in enumerate(CELLS * EACH):
        link, direction = cell.split()
        force = 10.0 * 2.0 ** (k // len(CELLS)) if scenario == "collision_sweep" else 120.0 + k
        start, name = 2.0 + 3.0 * k, f"collision_left_{link}_{direction}"
        rows.append(
            Collision(scenario, SEED, k + 1, name, "LL", link, direction, start, start + 0.003, start + 0.078, force,
                      0.05 * force, 0.4)
        )  # fmt: skip
    return rows


def detected(scenario: str) -> list[Detected]:
    """Return what each detector says: it finds the strongest, and MOB-Net-OR names each cell."""
    rows = []
    for name, share in FOUND.items():
        for one in collisions(scenario):
            turn = (one.number - 1) // len(CELLS)
            is_found = turn >= round(EACH * (1.0 - share))
            delay, perfect = (DELAY_S[name] + 0.001 * turn, 0.015) if is_found else (None, None)
            link = one.link if name == "MOB-Net-OR" else "foot"
            named = (f"mean.{'LL3'}", link, one.direction, one.force_n) if is_found else ("", "", "", None)
            for kind, ratio in RATIOS.items():
                size = ratio if is_found else 0.5
                rows.append(Detected(scenario, SEED, "LL", one.number, name, kind, size, delay, perfect, *named))
    return rows


def thresholds() -> list[Threshold]:
    return [
        Threshold(name, "LL", kind, f"{'std' if name.endswith('sigma') else 'mean'}.LL{j}", 1, size * j, "N m")
        for name in FOUND
        for kind, size in ((LARGEST, 1.5), (WALKING, 3.0), ("contact", 2.0), (COLLISION, 4.0))
        for j in range(1, 7)
    ]


def promises() -> list[Promise]:
    return [
        Promise(name, "LL", kind, SWINGS, HOURS, factor, rate, 0.2 * rate, 5.0 * rate)
        for name in FOUND
        for kind, factor, rate in (("contact", 1.0, 60.0), (COLLISION, 2.0, 1.0))
    ]


def swings() -> list[FreeSwing]:
    """Return swings: 0.0102, 0.0204, ... of the threshold for one false alarm an hour; in place below the paper's."""
    parts = (("long_walk", CALIBRATION), ("long_walk", HELD_OUT), ("place_walk", HELD_OUT), ("collisions", UNPUSHED))
    return [
        FreeSwing(name, "LL", scenario, part, TERRAINS[k % 2], SEED, k + 1, 0.0102 * k, paper, 0.9)
        for name in FOUND
        for scenario, part in parts
        for paper in [0.5 if scenario == "place_walk" else 1.5]
        for k in range(SWINGS)
    ]


def curves() -> list[CurvePoint]:
    """Return found collisions at multiples of the thresholds: fewer where they are higher."""
    count = EACH * len(CELLS)
    return [
        CurvePoint(name, "LL", factor, round(share * count / max(factor, 1.0)), count,
                   share * count / max(factor, 1.0) * DELAY_S[name] * factor)
        for name, share in FOUND.items()
        for factor in np.geomspace(0.1, 10.0, 9).tolist()
    ]  # fmt: skip

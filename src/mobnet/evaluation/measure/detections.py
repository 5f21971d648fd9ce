"""The rule `detect`: it calibrates a robot's detectors, counts their false alarms, and tries them on collisions."""

import logging
from collections.abc import Mapping
from dataclasses import astuple
from pathlib import Path
from typing import Any

from mobnet.core.detections import FILES, columns_of
from mobnet.core.estimator import Estimate
from mobnet.evaluation.measure.found import (
    candidates_of,
    collision_rows,
    curve_rows,
    detected_rows,
    strike,
    unpushed_rows,
)
from mobnet.evaluation.measure.tuned import promise_rows, quiet_rows, threshold_rows, tune
from mobnet.evaluation.measure.watching import Leg, Walk, read_estimate
from mobnet.evaluation.number.files import write_csv
from mobnet.robot.description import describe
from mobnet.settings.detection import Detection
from mobnet.settings.robot import RobotTable

log = logging.getLogger(__name__)
Rows = dict[str, list[Any]]  # name of a file -> its rows


def detect(
    detection: Detection, robot: RobotTable, rate_hz: float, walks: Mapping[str, Walk], out: Path
) -> None:  # fmt: skip
    """Calibrate and try the detectors of a robot, and write the files of `mobnet.core.detections` into a folder.

    Args:
        detection: gate, chain, thresholds and detectors.
        robot: the robot's table.
        rate_hz: samples per second [Hz].
        walks: scenario -> its recordings and estimates: those of `detection.collisions`, `sweep` and `quiet`.
        out: the folder.

    Raises:
        DataError: a walk has too few swings, a signal never changes, or a file is missing or damaged.
    """
    description, rows = describe(robot), {name: list[Any]() for name in FILES}
    for limb in detection.legs:
        _try_leg(Leg.of(detection, description, limb, rate_hz), walks, rows)
    for name, found in rows.items():
        write_csv(out / f"{name}.csv", columns_of(name), [astuple(row) for row in found])
    log.info("%s: %d collisions, %d detectors", out, len(rows["collisions"]), len(detection.detectors))


def _try_leg(leg: Leg, walks: Mapping[str, Walk], rows: Rows) -> None:
    """Add the rows of a leg: its collisions, then what each detector of a method that estimates it makes of them."""
    settings = leg.detection
    quiet, methods = leg.watch(walks[settings.quiet]), {row.method for row in settings.detectors.values()}
    struck = {name: strike(leg, walks[name], leg.watch(walks[name])) for name in (settings.collisions, settings.sweep)}
    for name, found in struck.items():
        rows["collisions"] += collision_rows(leg, name, found)
    for method in sorted(methods):
        read = {name: _estimates(leg, walk, method) for name, walk in walks.items()}
        for name, detector in settings.detectors.items():
            if detector.method != method or not read[settings.quiet]:
                continue  # the method does not estimate this leg
            tuned = tune(leg, name, detector, quiet, read[settings.quiet])
            rows["thresholds"] += threshold_rows(leg, tuned)
            rows["promises"] += promise_rows(leg, tuned, quiet)
            rows["swings"] += quiet_rows(leg, tuned, quiet, read[settings.quiet])
            for walk, found in struck.items():
                if read[walk]:
                    points = candidates_of(leg, walks[walk])
                    rows["detected"] += detected_rows(leg, walk, tuned, found, read[walk], points)
            rows["curves"] += curve_rows(leg, tuned, struck[settings.collisions], read[settings.collisions])
            rows["swings"] += unpushed_rows(leg, tuned, struck[settings.collisions], read[settings.collisions])
        log.info("%s, %s: tried", leg.limb, method)


def _estimates(leg: Leg, walk: Walk, method: str) -> list[Estimate]:
    """Return a method's estimates of a leg in a walk; none where it does not estimate it."""
    found = [read_estimate(stem, leg.joints) for stem in walk.estimates[method]]
    return [estimate for estimate in found if estimate is not None]

"""The rule `detect`: it calibrates a robot's detectors, counts their false alarms, and tries them on collisions."""

import logging
from collections.abc import Mapping, Sequence
from dataclasses import astuple
from pathlib import Path
from typing import Any

from mobnet.core.detections import FILES, columns_of
from mobnet.core.estimator import Estimate
from mobnet.evaluation.measure.detection.outcomes import (
    Struck,
    candidates_of,
    collision_rows,
    curve_rows,
    detected_rows,
    strike,
    unpushed_rows,
)
from mobnet.evaluation.measure.detection.tuning import (
    NotWatchedError,
    Tuned,
    promise_rows,
    quiet_of,
    quiet_rows,
    threshold_rows,
    tune,
)
from mobnet.evaluation.measure.detection.watching import Leg, read_estimate
from mobnet.evaluation.number.files import write_csv
from mobnet.plan.detection import Walk
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
        walks: scenario -> its recordings and estimates: those of `detection.collisions`, `sweep`, `place` and `random`.
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
    seen = {name: leg.watch(walk) for name, walk in walks.items()}
    struck = {name: strike(leg, walks[name], seen[name]) for name in (settings.collisions, settings.sweep)}
    for name, found in struck.items():
        rows["collisions"] += collision_rows(leg, name, found)
    for method in dict.fromkeys(row.method for row in settings.detectors.values()):
        read = {name: _estimates(leg, walk, method) for name, walk in walks.items()}
        if not read[settings.random]:
            continue  # the method does not estimate this leg
        quiet = {name: quiet_of(leg, name, seen[name], read[name]) for name in (settings.place, settings.random)}
        for name, detector in settings.detectors.items():
            if detector.method == method:
                try:
                    tuned = tune(leg, name, detector, quiet[settings.place], quiet[settings.random])
                except NotWatchedError as error:  # of networks that have hardly learned
                    log.warning("%s, %s is left out: %s", leg.limb, name, error)
                    continue
                rows["thresholds"] += threshold_rows(leg, tuned)
                rows["promises"] += promise_rows(leg, tuned, quiet[settings.random])
                for walk in quiet.values():
                    rows["swings"] += quiet_rows(leg, tuned, walk)
                for walk, found in struck.items():
                    _try_walk(leg, walk, tuned, found, read[walk], candidates_of(leg, walks[walk]), rows)
        log.info("%s, %s: tried", leg.limb, method)


def _try_walk(
    leg: Leg, scenario: str, tuned: Tuned, struck: Sequence[Struck], estimates: Sequence[Estimate],
    points: Sequence[str], rows: Rows,
) -> None:  # fmt: skip
    """Add what a detector makes of a walk with collisions; nothing where its method does not estimate the leg there."""
    if not estimates:
        return
    rows["detected"] += detected_rows(leg, scenario, tuned, struck, estimates, points)
    if scenario == leg.detection.collisions:
        rows["curves"] += curve_rows(leg, tuned, struck, estimates)
        rows["swings"] += unpushed_rows(leg, scenario, tuned, struck, estimates)


def _estimates(leg: Leg, walk: Walk, method: str) -> list[Estimate]:
    """Return a method's estimates of a leg in a walk; none where it does not estimate it."""
    found = [read_estimate(stem, leg.joints) for stem in walk.estimates[method]]
    return [estimate for estimate in found if estimate is not None]

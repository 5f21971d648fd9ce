"""The rule `detect`: it calibrates a robot's detectors, counts their false alarms, and tries them on collisions."""

import logging
from collections.abc import Mapping, Sequence
from dataclasses import astuple
from pathlib import Path
from typing import Any

from experiments.jobs.detector_trial import (
    LegHits,
    candidates_of,
    collision_rows,
    curve_rows,
    detected_rows,
    hit_legs,
    unpushed_rows,
)
from experiments.plan.detection import Walk
from experiments.records.collisions import FILES, columns_of
from mobnet.core.estimator import Estimate
from mobnet.core.files import write_text
from mobnet.core.rows import csv_text
from mobnet.detection.calibration import (
    CalibratedDetector,
    NotWatchedError,
    QuietWalk,
    calibrate_detector,
    promise_rows,
    quiet_rows,
    threshold_rows,
)
from mobnet.detection.watch import LegSetup, read_estimate
from mobnet.formats.plain import as_plain
from mobnet.formats.robot import RobotTable
from mobnet.kernel.detecting import WatchedSignals
from mobnet.robot.description import describe
from mobnet.settings.detection import Detection

log = logging.getLogger(__name__)
Rows = dict[str, list[Any]]  # name of a file -> its rows


def detect(detection: Detection, robot: RobotTable, rate_hz: float, walks: Mapping[str, Walk], out: Path) -> None:
    """Calibrate and try the detectors of a robot, and write the files of `records.collisions` into a folder.

    Args:
        detection: gate, chain, thresholds and detectors.
        robot: the robot's table.
        rate_hz: samples per second [Hz].
        walks: scenario -> its recordings and estimates: those of `detection.collisions`, `sweep`, `place` and `random`.
        out: the folder.

    Raises:
        DataError: a walk has too few swings, a signal never changes, or a file is missing or damaged.
    """
    description = describe(robot)
    rows = {name: list[Any]() for name in FILES}
    for number, limb in enumerate(detection.legs, start=1):
        log.info("leg %d of %d, %s", number, len(detection.legs), limb)
        _try_leg(LegSetup.of(detection, description, limb, rate_hz), walks, rows)
    for name, rows_of_file in rows.items():
        write_text(out / f"{name}.csv", csv_text(columns_of(name), map(astuple, rows_of_file)))
    log.info("%d collisions, %d detectors", len(rows["collisions"]), len(detection.detectors))


def _try_leg(setup: LegSetup, walks: Mapping[str, Walk], rows: Rows) -> None:
    """Add the rows of a leg: its collisions, then what each detector of a method that estimates it makes of them."""
    settings = setup.detection
    # One gate for all detectors, or they would differ by when they watch and not by their signals alone.
    gated = setup.detection.gate.method
    legs = {name: list(setup.recordings(walk.recordings, walk.estimates[gated])) for name, walk in walks.items()}
    hits = {name: hit_legs(setup, walks[name], legs[name]) for name in (settings.collisions, settings.sweep)}
    for name, hit in hits.items():
        rows["collisions"] += collision_rows(setup, name, hit)
    methods = dict.fromkeys(row.method for row in settings.detectors.values())
    for number, method in enumerate(methods, start=1):
        estimates = {name: _estimates(setup, walk, method) for name, walk in walks.items()}
        if not estimates[settings.random]:
            continue  # the method does not estimate this leg
        place, random = (
            QuietWalk.of(setup, name, legs[name], estimates[name], settings.calibration_share)
            for name in (settings.place, settings.random)
        )
        for name, detector in settings.detectors.items():
            if detector.method == method:
                try:
                    calibrated = calibrate_detector(setup, name, as_plain(detector, WatchedSignals), place, random)
                except NotWatchedError as error:  # of networks that have hardly learned
                    log.warning("%s, %s is left out: %s", setup.limb, name, error)
                    continue
                rows["thresholds"] += threshold_rows(setup, calibrated)
                rows["promises"] += promise_rows(setup, calibrated, random)
                for quiet in (place, random):
                    rows["swings"] += quiet_rows(setup, calibrated, quiet)
                for scenario, hit in hits.items():
                    points = candidates_of(setup, walks[scenario])
                    _try_walk(setup, scenario, calibrated, hit, estimates[scenario], points, rows)
        log.info("%d of %d methods of %s tried: %s", number, len(methods), setup.limb, method)


def _try_walk(
    setup: LegSetup,
    scenario: str,
    calibrated: CalibratedDetector,
    walk: Sequence[LegHits],
    estimates: Sequence[Estimate],
    points: Sequence[str],
    rows: Rows,
) -> None:
    """Add what a detector makes of a walk with collisions; nothing where its method does not estimate the leg there."""
    if not estimates:
        return
    rows["detected"] += detected_rows(setup, scenario, calibrated, walk, estimates, points)
    if scenario == setup.detection.collisions:
        rows["curves"] += curve_rows(setup, calibrated, walk, estimates)
        rows["swings"] += unpushed_rows(setup, scenario, calibrated, walk, estimates)


def _estimates(setup: LegSetup, walk: Walk, method: str) -> list[Estimate]:
    """Return a method's estimates of a leg in a walk; none where it does not estimate it."""
    estimates = [read_estimate(stem, setup.joints) for stem in walk.estimates[method]]
    return [estimate for estimate in estimates if estimate is not None]

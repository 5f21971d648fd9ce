"""The rule `react`: a robot walks into obstacles or freely, with our detector and with others, and what comes of it."""

import logging
from collections.abc import Mapping, Sequence
from dataclasses import astuple, dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from experiments.jobs.calm import FORCE
from experiments.jobs.reacting_robot import BASE_LIMB, ReactingRobot
from experiments.jobs.reaction_trial import trial_of
from experiments.plan.parts import CaseWalks, MethodRun
from experiments.records.course import course_columns
from experiments.records.reactions import FORCE_SENSORS, NONE, TRIALS, Trial
from mobnet.core.arrays import Array
from mobnet.core.detections import Threshold
from mobnet.core.estimator import TorqueEstimator, once
from mobnet.core.files import write_text
from mobnet.core.recording import Sensed
from mobnet.core.rows import csv_text, read_rows
from mobnet.core.store import write_array
from mobnet.detection.detector import LegDetector
from mobnet.detection.signals import Watched
from mobnet.detection.watch import LegSetup
from mobnet.formats.plain import as_plain
from mobnet.kernel.detecting import WatchedSignals
from mobnet.reaction.handler import Handler, Watcher
from mobnet.reaction.loop import Course, columns_of, walk_with
from mobnet.reaction.numbers import ReactionNumbers
from mobnet.reaction.watchers import BaseWatcher, FootWatcher, LegWatcher, LimbWatcher, OwnLegWatcher
from mobnet.settings.detection import Detection
from mobnet.settings.methods import ObserverSettings
from mobnet.settings.reaction import Reaction, Watch, watches_of
from mobnet.simulation.simulator import Simulator

log = logging.getLogger(__name__)


def react(
    reaction: Reaction,
    detection: Detection,
    observer: ObserverSettings,
    runs: Mapping[str, MethodRun],
    thresholds: Sequence[Path],
    walks: CaseWalks,
    out: Path,
) -> None:
    """Write the trials of a case with a robot, rows of `Trial`, and where something pushes it the first walk's course.

    Args:
        reaction: numbers of the pipeline, and the cases.
        detection: gate, chain and detectors.
        observer: the observer's settings.
        runs: networks and fit of the method in the loop, and of those of detectors.
        thresholds: files of the robot's thresholds, by rules `detect` and `watch`.
        walks: the walks of the case.
        out: file of the trials; the course, as `course_columns` says, stands beside it by its name without an ending.

    Raises:
        DataError: a file is missing or damaged.
    """
    rows: list[Threshold] = []
    for path in thresholds:
        rows += read_rows(path, Threshold)
    robot_walks = CaseWalker(ReactingRobot(walks.settings, reaction, detection, observer, runs), rows)
    trials = list[Trial]()
    ours, *others = watches_of(reaction, walks.case)
    tried = [(ours, walks.seeds), *((other, walks.seeds[: walks.sizes.compared]) for other in others)]
    count = sum(len(seeds) for _, seeds in tried)
    for watch, seeds in tried:
        for seed in seeds:
            trial, walked = robot_walks.walk(walks, watch, seed)
            if not trials and walks.is_pushed:
                write_course(walked, trial, robot_walks, out.with_suffix(""))
            trials.append(trial)
            log.info("%d of %d walks, %s", len(trials), count, walks.case)
        log.info("%s, %s, %s: %d walks", walks.case, watch.detector, watch.rule, len(seeds))
    write_text(out, csv_text(TRIALS, [astuple(trial) for trial in trials]))


@dataclass(frozen=True)
class CaseWalker:
    """A robot with its thresholds that walks cases; `estimators` are those of the methods that it needed so far."""

    robot: ReactingRobot
    thresholds: Sequence[Threshold]
    estimators: dict[str, TorqueEstimator] = field(default_factory=dict)

    def walk(self, case: CaseWalks, watch: Watch, seed: int) -> tuple[Trial, Course]:
        """Walk a case; return what came of it, and the course."""
        robot = self.robot
        numbers = self.robot.reaction
        settings = case.settings
        watch = watch.model_copy(update={"wrench": watch.wrench or settings.scenario.wrench})
        scenario = settings.scenario.model_copy(update={"wrench": watch.wrench})
        simulator = Simulator(settings.model_copy(update={"scenario": scenario}), seed)
        simulator.start()
        row = numbers.cases[case.case]
        watchers = self.watchers(watch, simulator.sensors.wrenches, row.limbs)
        times_s = watch.wait_s, settings.recording.settle_s, case.sizes.longest_s, numbers.after_s
        wait, settle, longest, after = (round(time_s * robot.rate_hz) for time_s in times_s)
        spacing_m = settings.walking.foot_spacing_m
        handler = Handler(
            robot.description, as_plain(numbers, ReactionNumbers), spacing_m, watchers, row.strategy, wait, settle
        )
        height_m = robot.detection.gate.contact_height_m
        estimator = self.estimator(numbers.estimator)
        sizes = (longest, after, numbers.touch_n, height_m)
        course = walk_with(simulator, estimator, handler, *sizes, watch.feed_forward)
        place = case.case, settings.level_name, seed
        stopped = bool(simulator.state.standing)
        mid_swing = self.mid_swing(row.leg, course)
        return trial_of(numbers, place, watch, course, settle, robot.rate_hz, stopped, mid_swing), course

    def mid_swing(self, leg: str | None, course: Course) -> NDArray[np.bool_] | None:
        """Return in which samples of a course (T,) the gate of a leg is open by the plan alone; None without a leg."""
        if leg is None:
            return None
        setup = next(setup for setup in self.robot.setups if setup.limb == leg)
        places = columns_of(self.robot.description.layout)
        sensed = Sensed(*(course.rows[:, places[name]] for name in Sensed.__dataclass_fields__))
        # Without a torque the gate takes no contact for an early landing: whatever the leg meets, the swing goes on.
        return setup.gate.run(sensed, np.zeros((len(sensed), len(setup.joints)))).watched

    def estimator(self, method: str) -> TorqueEstimator:
        """Return the estimator of a method; its networks are read once, its state is that of a walk.

        The method in the loop estimates all joints, another one those of the legs that its detector watches.
        """
        if method not in self.estimators:
            limbs = () if method == self.robot.reaction.estimator else self.robot.detection.legs
            self.estimators[method] = once(self.robot.estimator(method, limbs))  # both legs ask for it
        return self.estimators[method]

    def watchers(self, watch: Watch, wrenches: Array, limbs: Sequence[str] = ()) -> dict[str, Watcher]:
        """Return what watches each limb; `wrenches` (2, 6) are the readings of the feet's sensors.

        Nothing watches a robot that does not react. Limbs that are no legs are watched by the method in the loop alone,
        and where `limbs` are named, those among them.
        """
        if watch.detector == NONE:
            return {}
        setups = self.robot.setups
        estimator = self.robot.reaction.estimator
        legs = {setup.limb: watcher for setup in setups if (watcher := self._leg(setup, watch, wrenches))}
        row = self.robot.detection.detectors.get(watch.detector)
        if row is None or row.method != estimator:
            return legs
        watched = [limb for limb in self.robot.reaction.watched if not limbs or limb in limbs]
        return legs | {limb: self._limb(limb) for limb in watched}

    def _limb(self, limb: str) -> Watcher:
        """Return what watches a limb all the time; the base is watched by the unexpected force on it."""
        ours = self.robot.reaction.ours
        robot = self.robot
        watched = robot.watched
        thresholds = self._values(ours.detector, limb, ours.rule)
        values = np.array([[thresholds[1, name] for name in watched.names(robot.joints_of(limb))]])
        chain = robot.setups[0].chain(values)
        if limb == BASE_LIMB:
            return BaseWatcher(watched, chain, robot.base)
        return LimbWatcher(watched, chain, robot.columns(limb))

    def _leg(self, setup: LegSetup, watch: Watch, wrenches: Array) -> Watcher | None:
        """Return what watches a leg; nothing where rule `detect` found no thresholds for the detector."""
        columns = self.robot.columns(setup.limb)
        thresholds = self._values(watch.detector, setup.limb, watch.rule)
        if not thresholds:  # the method does not estimate this leg, or its networks have hardly learned
            return None
        if watch.detector == FORCE_SENSORS:
            return FootWatcher(
                setup.gate, setup.chain(np.array([[thresholds[1, FORCE]]]), norm=True), columns, wrenches
            )
        row = self.robot.detection.detectors[watch.detector]
        watched = Watched(as_plain(row, WatchedSignals))
        names = watched.names(setup.joints)
        limits: list[list[float]] = []
        for phase in range(1, row.phases + 1):
            limits.append([thresholds[phase, name] for name in names])
        chain = setup.chain(np.array(limits))
        detector = LegDetector(watched, setup.gate, chain)
        if row.method == self.robot.reaction.estimator:
            return LegWatcher(detector, columns)
        estimator = self.estimator(row.method)
        joint_columns = np.array([estimator.joints.index(joint) for joint in setup.joints])
        return OwnLegWatcher(detector, columns, estimator, joint_columns)

    def _values(self, detector: str, limb: str, rule: str) -> dict[tuple[int, str], float]:
        """Return phase and signal -> threshold of a limb's detector by a rule; empty where it has none."""
        asked = detector, limb, rule
        rows = [row for row in self.thresholds if (row.detector, row.leg, row.kind) == asked]
        return {(row.phase, row.signal): row.value for row in rows}


def write_course(course: Course, trial: Trial, walks: CaseWalker, out: Path) -> None:
    """Write a course, with the times of its trial in the note and the places of the obstacles."""
    robot = walks.robot
    joints = walks.estimator(walks.robot.reaction.estimator).joints
    layout = robot.description.layout
    columns = layout.columns(joints)
    parts = course.rows, course.tau[:, columns], course.std[:, columns], course.force, course.point, course.base
    array = np.concatenate(parts, axis=1)
    meta = {"rate_hz": robot.rate_hz, "seed": trial.seed, "case": trial.case, "level": trial.level}
    meta["obstacles"] = {name: place.tolist() for name, place in course.obstacles.items()}
    times = {"contact_s": trial.contact_s, "alarm_s": trial.alarm_s, "reacted_s": trial.reacted_s, "limb": trial.limb}
    write_array(out, array, course_columns(layout, joints), {**meta, **times}, [(0, len(array))])

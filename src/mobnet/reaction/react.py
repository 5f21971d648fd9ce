"""The rule `react`: a robot walks into obstacles, with our detector and with others, and what comes of it."""

import logging
from collections.abc import Collection, Mapping, Sequence
from dataclasses import astuple, dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.core.columns import ESTIMATED, STD, Column, recording_columns, torque_columns
from mobnet.core.detections import Threshold
from mobnet.core.estimator import Estimator
from mobnet.core.files import write_text
from mobnet.core.joints import JointLayout
from mobnet.core.reactions import FORCE_SENSORS, NONE, TRIALS, Trial
from mobnet.core.recording import Recording, read_recording
from mobnet.core.rows import csv_text, read_rows
from mobnet.core.store import write_array
from mobnet.detection.detector import LegDetector
from mobnet.detection.signals import Watched
from mobnet.detection.watch import LegSetup
from mobnet.estimation.methods import build_estimator
from mobnet.estimation.recipe import Recipe
from mobnet.plan.parts import MethodRun
from mobnet.reaction.calm import first_part, foot_threshold, limb_thresholds
from mobnet.reaction.contacts import end_effectors
from mobnet.reaction.handler import Handler, Watcher
from mobnet.reaction.loop import Course, walk_with
from mobnet.reaction.trial import trial_of
from mobnet.reaction.watchers import FootWatcher, LegWatcher, LimbWatcher, OwnLegWatcher
from mobnet.robot.description import RobotDescription, describe
from mobnet.settings.detection import Detection
from mobnet.settings.methods import Observer
from mobnet.settings.reaction import Reaction, Watch
from mobnet.settings.scales import ReactionSizes
from mobnet.settings.settings import WalkSettings
from mobnet.simulation.simulator import Simulator

log = logging.getLogger(__name__)


def react(
    settings: WalkSettings, reaction: Reaction, detection: Detection, observer: Observer, case: str,
    runs: Mapping[str, MethodRun], thresholds: Path, quiet: Path, seeds: Sequence[int], sizes: ReactionSizes, out: Path,
    course: Path,
) -> None:  # fmt: skip
    """Write the trials of a case of `reaction.cases` with a robot, rows of `Trial`, and the course of the first one.

    Args:
        settings: the scenario on this robot.
        reaction: numbers of the pipeline, and the cases.
        detection: gate, chain and detectors.
        observer: the observer's settings.
        case: the case.
        runs: networks and fit of the method in the loop, and of those of detectors.
        thresholds: file of the robot's thresholds.
        quiet: recording of walking that nothing pushes, by which limbs and sensors of feet are calibrated.
        seeds: of the walks; the first `sizes.compared` of them also with what the case compares.
        sizes: numbers of walks, and the longest duration of one.
        out: file.
        course: where the course of the first walk is written, without an ending, as `course_columns` says.

    Raises:
        DataError: a file is missing or damaged.
    """
    rows = tuple(read_rows(thresholds, Threshold))
    robot = Robot(settings, reaction, detection, observer, runs, rows, quiet, sizes.longest_s)
    row, trials = reaction.cases[case], list[Trial]()
    for watch, some in [(reaction.ours, seeds), *((other, seeds[: sizes.compared]) for other in row.compared)]:
        for seed in some:
            trial, walked = robot.walk(case, watch, seed)
            if not trials:
                write_course(walked, trial, robot, course)
            trials.append(trial)
        log.info("%s, %s, %s: %d walks", case, watch.detector, watch.rule, len(some))
    write_text(out, csv_text(TRIALS, [astuple(trial) for trial in trials]))


@dataclass(frozen=True)
class Robot:
    """A robot and its estimators, for walks into obstacles; attributes as the arguments of `react`."""

    settings: WalkSettings
    reaction: Reaction
    detection: Detection
    observer: Observer
    runs: Mapping[str, MethodRun]
    thresholds: Sequence[Threshold]
    quiet: Path
    longest_s: float

    def walk(self, case: str, watch: Watch, seed: int) -> tuple[Trial, Course]:
        """Walk into the obstacle of a case; return what came of it, and the course."""
        numbers, rate_hz = self.reaction, self.rate_hz
        simulator = Simulator(self.settings, seed)
        simulator.start()
        watchers, row = self.watchers(watch, simulator.sensors.wrenches), numbers.cases[case]
        wait, settle = (round(time_s * rate_hz) for time_s in (watch.wait_s, self.settings.recording.settle_s))
        spacing_m = self.settings.walking.foot_spacing_m
        handler = Handler(self.robot, numbers, spacing_m, watchers, row.strategy, wait, settle)
        longest, after = (round(time_s * rate_hz) for time_s in (self.longest_s, numbers.after_s))
        course = walk_with(simulator, self._loop, handler, longest, after, numbers.touch_n)
        place = case, self.settings.level_name, seed
        return trial_of(numbers, place, watch, course, rate_hz, bool(simulator.state.standing)), course

    @cached_property
    def robot(self) -> RobotDescription:
        """The robot."""
        return describe(self.settings.robot)

    @property
    def joints(self) -> tuple[str, ...]:
        """The joints that are estimated in the loop."""
        return self._loop.joints

    @property
    def rate_hz(self) -> float:
        """Samples per second [Hz]."""
        return self.settings.rates.data_hz

    def estimator(self, method: str, limbs: Collection[str] = ()) -> Estimator:
        """Return the estimator of a method with this robot's networks, of some limbs alone if asked, and its fit."""
        run, settings = self.runs[method], self.settings
        networks = {limb: folder for limb, folder in run.networks.items() if not limbs or limb in limbs}
        gravity, own = settings.plant.gravity_m_s2, (networks, run.fitted)
        recipe = Recipe(method, run.methods, settings.robot, settings.level, gravity, self.observer, self.rate_hz, *own)
        return build_estimator(recipe)

    def watchers(self, watch: Watch, wrenches: Array) -> dict[str, Watcher]:
        """Return what watches each limb; `wrenches` (2, 6) are the readings of the feet's sensors.

        Nothing watches a robot that does not react. Hands and arms are watched by the method in the loop alone.
        """
        if watch.detector == NONE:
            return {}
        legs = {setup.limb: watcher for setup in self.setups if (watcher := self._leg(setup, watch, wrenches))}
        row = self.detection.detectors.get(watch.detector)
        return legs | self._arms if row and row.method == self.reaction.estimator else legs

    def _leg(self, setup: LegSetup, watch: Watch, wrenches: Array) -> Watcher | None:
        """Return what watches a leg; nothing where rule `detect` found no thresholds for the detector."""
        columns = self._columns(setup.limb)
        if watch.detector == FORCE_SENSORS:
            chain = setup.chain(self._foot_thresholds[setup.limb], norm=True)
            return FootWatcher(setup.gate, chain, columns, wrenches)
        detector = self._detector(setup, watch)
        if detector is None:  # the method does not estimate this leg, or its networks have hardly learned
            return None
        method = self.detection.detectors[watch.detector].method
        if method == self.reaction.estimator:
            return LegWatcher(detector, columns)
        estimator = self.estimator(method)
        held = np.array([estimator.joints.index(joint) for joint in setup.joints])
        return OwnLegWatcher(detector, columns, estimator, held)

    def _detector(self, setup: LegSetup, watch: Watch) -> LegDetector | None:
        """Return a leg's detector with this robot's thresholds; None where it has none."""
        detector = self.detection.detectors[watch.detector]
        watched, asked = Watched(detector), (watch.detector, setup.limb, watch.rule)
        rows = [row for row in self.thresholds if (row.detector, row.leg, row.kind) == asked]
        if not rows:
            return None
        own = {(row.phase, row.signal): row.value for row in rows}
        names = watched.names(setup.joints)
        chain = setup.chain(np.array([[own[phase, name] for name in names] for phase in range(1, detector.phases + 1)]))
        return LegDetector(watched, setup.gate, chain)

    @cached_property
    def setups(self) -> list[LegSetup]:
        """The legs."""
        return [LegSetup.of(self.detection, self.robot, limb, self.rate_hz) for limb in self.detection.legs]

    @cached_property
    def calm(self) -> Recording:
        """The beginning of the walk that nothing pushes."""
        return first_part(read_recording(self.quiet, self.robot.layout), round(self.reaction.calm_s * self.rate_hz))

    @cached_property
    def _foot_thresholds(self) -> dict[str, Array]:
        """Threshold of the force on the foot of each leg (1, 1) [N], by its sensor."""
        return {setup.limb: foot_threshold(setup, self.calm) for setup in self.setups}

    @cached_property
    def _loop(self) -> Estimator:
        """The estimator in the loop, whose state is that of a walk."""
        return self.estimator(self.reaction.estimator)

    @cached_property
    def _arms(self) -> dict[str, Watcher]:
        """What watches the limbs with hands, by name."""
        limbs = [limb for limb in end_effectors(self.robot) if limb not in self.detection.legs]
        estimator, setup, found = self.estimator(self.reaction.estimator, limbs), self.setups[0], dict[str, Watcher]()
        for limb in limbs:
            thresholds = limb_thresholds(setup, self.calm, estimator, self.robot.layout.limb(limb))
            found[limb] = LimbWatcher(setup.chain(thresholds), self._columns(limb))
        return found

    def _columns(self, limb: str) -> NDArray[np.int64]:
        """Return the places of a limb's joints in a generalized velocity."""
        return self.robot.layout.columns(self.robot.layout.limb(limb))


def course_columns(layout: JointLayout, joints: Sequence[str]) -> list[Column]:
    """Return the columns of a course: the recording, what is estimated of joints, and the force of the obstacles."""
    recorded = [column for columns in recording_columns(layout).values() for column in columns]
    estimated = torque_columns(layout, (ESTIMATED, STD), joints)
    return [*recorded, *estimated, *((f"obstacle.force_{axis}", "N", "world") for axis in "xyz")]


def write_course(course: Course, trial: Trial, robot: Robot, out: Path) -> None:
    """Write a course, with the times of its trial in the note."""
    layout, joints = robot.robot.layout, robot.joints
    held = layout.columns(joints)
    array = np.concatenate([course.rows, course.tau[:, held], course.std[:, held], course.force], axis=1)
    meta = {"rate_hz": robot.rate_hz, "seed": trial.seed, "case": trial.case, "level": trial.level}
    times = {"contact_s": trial.contact_s, "alarm_s": trial.alarm_s, "reacted_s": trial.reacted_s, "limb": trial.limb}
    write_array(out, array, course_columns(layout, joints), {**meta, **times}, [(0, len(array))])

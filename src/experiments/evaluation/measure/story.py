"""The stored push as methods feel it: estimators step through it as on a robot.

Its files are those of `experiments.plan.demo`; docs/demo has those of the published run.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import product
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from experiments.evaluation.compare.windows import FLAG
from experiments.evaluation.measure.push_scene import FORCE, PushAlarm, PushScene
from experiments.evaluation.number.rows import read_detections
from experiments.plan.demo import RECORDING, fit_place, network_place
from experiments.records.collisions import Collision
from experiments.settings.catalogue import Catalogue
from experiments.settings.pages import Story
from experiments.settings.settings import Settings
from mobnet.core.arrays import Array
from mobnet.core.columns import EXTERNAL, PUSH, PUSH_TORQUE, named
from mobnet.core.detections import Threshold
from mobnet.core.errors import ConfigError, DataError, not_accepted, refuse
from mobnet.core.estimator import Estimate, TorqueEstimator
from mobnet.core.recording import SensedRecording
from mobnet.core.recording_file import read_sensed
from mobnet.core.store import check_rate, read_array
from mobnet.detection.detector import ALARM_RATIO, LegDetector
from mobnet.detection.signals import Watched
from mobnet.detection.watch import LegSetup
from mobnet.estimation.kinds import build_estimator
from mobnet.estimation.recipe import Recipe
from mobnet.formats.plain import as_plain
from mobnet.kernel.detecting import WatchedSignals
from mobnet.kernel.low_pass import low_pass
from mobnet.robot.description import RobotDescription, describe
from mobnet.settings.detection import DetectorSettings


@dataclass(frozen=True)
class StoredPush:
    """The files of a stored push in a folder, and the configuration of what runs on them.

    What is missing or damaged is a DataError where it is read first.
    """

    folder: Path
    settings: Settings

    @property
    def story(self) -> Story:
        """Which push it is."""
        return self.settings.evaluation.story

    @cached_property
    def robot(self) -> RobotDescription:
        """The robot's body."""
        return describe(self.settings.robot)

    @cached_property
    def collision(self) -> Collision:
        """The push: its times, force, and the leg that it hits."""
        path = self.folder / "collisions.csv"
        rows: list[Collision] = read_detections(path, "collisions")
        if len(rows) != 1:
            raise DataError(not_accepted(f"{path}: number of rows", len(rows), ["1, that of the push"]))
        return rows[0]

    @property
    def joints(self) -> tuple[str, ...]:
        """The joints of the leg, (n,)."""
        return self.robot.layout.limb(self.collision.leg)

    @cached_property
    def recording(self) -> SensedRecording:
        """What the robot sensed, T samples."""
        check_rate(self.folder / RECORDING, self.settings.rates.data_hz)
        return read_sensed(self.folder / RECORDING, self.robot.layout)

    def scene(self, estimates: Mapping[str, Estimate]) -> PushScene:
        """Return the push as estimates of the leg's joints (T, n) [N m] show it, those of the methods by name.

        Raises:
            DataError: a file is missing or damaged.
        """
        story = self.story
        collision = self.collision
        sensed = self.recording.sensed
        rate_hz = self.recording.rate_hz
        gain_hz = self.settings.observer.gain_hz
        start = round(story.before_s * rate_hz)
        stds = {method: estimate.std for method, estimate in estimates.items() if estimate.std is not None}
        pushed = self._read([f"{PUSH}.row"])[:, 0] > FLAG
        alarm_s = self._alarm_s(estimates, pushed)
        return PushScene(
            joints=self.joints,
            rate_hz=rate_hz,
            gain_hz=gain_hz,
            first=0,
            settled=round(story.settle_s * rate_hz),
            start=start,
            end=start + round((collision.end_s - collision.start_s) * rate_hz),
            truth=low_pass(self._read(named(EXTERNAL, self.joints)), gain_hz, rate_hz),
            push=self._read(named(PUSH_TORQUE, self.joints)),
            estimates={method: estimate.tau_ext for method, estimate in estimates.items()},
            stds=stds,
            flags={"swing": sensed.swing[:, self._setup.gate.foot] > FLAG, "pushed": pushed},
            q=sensed.q.astype(np.float64),
            force=self._read(FORCE).astype(np.float64),
            alarm=None if alarm_s is None else PushAlarm(alarm_s),
        )

    def estimator(self, method: str) -> TorqueEstimator:
        """Return a method's estimator; a ConfigError names a method whose files are not stored."""
        if method not in self.story.methods:
            raise ConfigError(not_accepted("method", method, self.story.methods))
        catalogue = Catalogue(self.settings)
        limb = self.collision.leg
        settings = self.settings
        source = catalogue.network_source_of(method)
        fitted = catalogue.source_of(method)
        networks = {limb: self.folder / network_place(source, limb)} if catalogue.method(source).limbs else {}
        fit = self.folder / fit_place(fitted) if catalogue.method(fitted).fitted else None
        methods = {name: catalogue.method(name) for name in (method, fitted)}
        ratio = settings.levels[self.story.level].nominal_mass_ratio
        gravity = settings.plant.gravity_m_s2
        rate_hz = self.recording.rate_hz
        return build_estimator(
            Recipe(method, methods, settings.robot, ratio, gravity, settings.observer, rate_hz, networks, fit)
        )

    def estimate(self, method: str) -> Estimate:
        """Return what a method makes of the leg's joints, step by step from its first state, (T, n) [N m]."""
        estimator = self.estimator(method)
        sensed = self.recording.sensed
        columns = [estimator.joints.index(joint) for joint in self.joints]
        state = estimator.init()
        # Step by step as on a robot, which has no later samples.
        steps = list[Estimate]()
        for k in range(len(sensed)):
            state, estimate = estimator.step(state, sensed[k])
            steps.append(estimate)
        tau = np.array([step.tau_ext for step in steps])
        std = [step.std for step in steps if step.std is not None]
        return Estimate(tau[:, columns], np.array(std)[:, columns] if std else None)

    def _alarm_s(self, estimates: Mapping[str, Estimate], pushed: NDArray[np.bool_]) -> float | None:
        """Return how long after the beginning of the push the detector of the story says so [s], None if it does not.

        An alarm counts until some time after the push (T,), as in Table 9.
        """
        setup = self._setup
        row = self.settings.detection.detectors[self.story.detector]
        detector = LegDetector(Watched(as_plain(row, WatchedSignals)), setup.gate, setup.chain(self._thresholds(row)))
        gate = setup.gate.run(self.recording.sensed, estimates[setup.detection.gate.method].tau_ext)
        ratio = detector.run(gate, self.recording.sensed, estimates[row.method]).ratio
        start = round(self.story.before_s * setup.rate_hz)
        end = int(np.flatnonzero(pushed)[-1]) + 1 + round(setup.detection.late_s * setup.rate_hz)
        alarms = np.flatnonzero(ratio[start:end] > ALARM_RATIO)
        return float(alarms[0]) / setup.rate_hz if len(alarms) else None

    @cached_property
    def _setup(self) -> LegSetup:
        return LegSetup.of(self.settings.detection, self.robot, self.collision.leg, self.recording.rate_hz)

    def _thresholds(self, row: DetectorSettings) -> Array:
        """Return the thresholds of a detector, (phases, signals) [N m], of a ratio [-]."""
        path = self.folder / "thresholds.csv"
        names = Watched(as_plain(row, WatchedSignals)).names(self.joints)
        stored: list[Threshold] = read_detections(path, "thresholds")
        values = {(each.phase, each.signal): each.value for each in stored}
        wanted = list(product(range(1, row.phases + 1), names))
        missing = [place for place in wanted if place not in values]
        accepted = f"one of each signal of {row.method}"
        refuse(
            path, (f"threshold of {name}, phase {phase}, is missing; accepted: {accepted}" for phase, name in missing)
        )
        return np.array([values[place] for place in wanted]).reshape(row.phases, len(names))

    def _read(self, names: list[str]) -> NDArray[np.float32]:
        return read_array(self.folder / RECORDING, names, self.robot.layout)[0]

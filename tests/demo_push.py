"""The stored push of docs/demo with the published configuration, as the library alone reads it."""

import csv
from functools import cached_property
from pathlib import Path

import numpy as np

from mobnet.core.estimator import Estimate
from mobnet.core.recording_file import read_sensed
from mobnet.detection.signals import Watched
from mobnet.detection.watch import LegSetup
from mobnet.estimation.kinds import build_estimator
from mobnet.formats.plain import as_plain
from mobnet.kernel.detecting import WatchedSignals
from mobnet.robot.description import describe

DATA = Path(__file__).parents[1] / "docs" / "demo"
NETWORK = DATA / "networks" / "MOB-Net-pushed-LL"
LEG, PLANT = "LL", "robot_1"


class DemoPush:
    """What the robot sensed, and the estimators and the detector that the stored network has in its leg."""

    folder = DATA
    detector = "MOB-Net-pushed-ratio"

    def __init__(self, settings, recipe_of):
        self.settings, self._recipe_of = settings, recipe_of
        self.robot = describe(settings.robot)
        self.joints = self.robot.layout.limb(LEG)
        self.recording = read_sensed(DATA / "recording", self.robot.layout)

    def estimator(self, method):
        networks = {LEG: NETWORK} if self.settings.methods[method].limbs else {}
        return build_estimator(self._recipe_of(method, PLANT, networks=networks))

    def estimate(self, method):
        """Return what a method makes of the leg's joints, step by step from its first state, (T, n) [N m]."""
        estimator, sensed = self.estimator(method), self.recording.sensed
        held = [estimator.joints.index(joint) for joint in self.joints]
        state, steps = estimator.init(), []
        for k in range(len(sensed)):
            state, estimate = estimator.step(state, sensed[k])
            steps.append(estimate)
        tau = np.array([one.tau_ext for one in steps])[:, held]
        return Estimate(tau, np.array([one.std for one in steps])[:, held] if steps[0].std is not None else None)

    @property
    def row(self):
        return self.settings.detection.detectors[self.detector]

    @cached_property
    def setup(self):
        return LegSetup.of(self.settings.detection, self.robot, LEG, self.recording.rate_hz)

    @property
    def gate(self):
        return self.setup.gate

    @cached_property
    def chain(self):
        """The filters of the detector, with the thresholds of the published run."""
        with (DATA / "thresholds.csv").open() as file:
            values = {(int(row["phase"]), row["signal"]): float(row["value"]) for row in csv.DictReader(file)}
        names = Watched(as_plain(self.row, WatchedSignals)).names(self.joints)
        limits = [[values[phase, name] for name in names] for phase in range(1, self.row.phases + 1)]
        return self.setup.chain(np.array(limits))

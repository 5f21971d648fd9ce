"""A robot with its estimators and the gates of its legs, as walks with an estimator in the loop need it."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from numpy.typing import NDArray

from experiments.plan.parts import MethodRun
from mobnet.core.estimator import ResidualObserver, TorqueEstimator, once
from mobnet.detection.signals import Watched
from mobnet.detection.watch import LegSetup
from mobnet.estimation.kinds import build_estimator
from mobnet.estimation.observe import observer_of
from mobnet.estimation.recipe import Recipe
from mobnet.formats.plain import as_plain
from mobnet.kernel.detecting import WatchedSignals
from mobnet.reaction.numbers import WrenchDamping
from mobnet.reaction.watchers import BaseForce
from mobnet.robot.description import RobotDescription, describe
from mobnet.settings.detection import Detection
from mobnet.settings.methods import ObserverSettings
from mobnet.settings.reaction import Reaction
from mobnet.settings.walking import WalkSettings

BASE_LIMB = "V"  # the six virtual joints, three forces and three moments on the base


@dataclass(frozen=True)
class ReactingRobot:
    """A robot that walks, with the networks and fits of methods.

    Attributes:
        settings: a scenario on this robot, whatever it walks.
        reaction: numbers of the pipeline, and the cases.
        detection: gate, chain and detectors.
        observer: the observer's settings.
        runs: networks and fit of each method.
    """

    settings: WalkSettings
    reaction: Reaction
    detection: Detection
    observer: ObserverSettings
    runs: Mapping[str, MethodRun]

    @cached_property
    def description(self) -> RobotDescription:
        """The robot's body."""
        return describe(self.settings.robot)

    @property
    def rate_hz(self) -> float:
        """Samples per second [Hz]."""
        return self.settings.rates.data_hz

    @cached_property
    def setups(self) -> list[LegSetup]:
        """The legs."""
        return [LegSetup.of(self.detection, self.description, limb, self.rate_hz) for limb in self.detection.legs]

    @property
    def watched(self) -> Watched:
        """What our detector watches."""
        return Watched(as_plain(self.detection.detectors[self.reaction.ours.detector], WatchedSignals))

    @cached_property
    def base(self) -> BaseForce:
        """The unexpected force on the base."""
        numbers = as_plain(self.reaction.identification, WrenchDamping)
        return BaseForce.of(self.description, numbers, self.detection.gate.contact_height_m)

    def joints_of(self, limb: str) -> tuple[str, ...]:
        """Return the joints of which a limb's signals are named when it is watched all the time: forces of the base."""
        joints = self.description.layout.limb(limb)
        return joints[:3] if limb == BASE_LIMB else joints

    @cached_property
    def _shared(self) -> ResidualObserver:
        """The observer of all estimators, which runs once a tick whoever asks."""
        level = self.settings.level
        gravity = self.settings.plant.gravity_m_s2
        known = self.description, level.nominal_mass_ratio, gravity
        return once(observer_of(*known, self.observer.gain_hz, self.rate_hz, self.observer.torque))

    def estimator(self, method: str, limbs: Collection[str] = ()) -> TorqueEstimator:
        """Return the estimator of a method with this robot's networks, of some limbs alone if asked, and its fit."""
        run = self.runs[method]
        settings = self.settings
        networks = {limb: folder for limb, folder in run.networks.items() if not limbs or limb in limbs}
        gravity = settings.plant.gravity_m_s2
        given = (networks, run.fitted)
        known = settings.robot, settings.level.nominal_mass_ratio, gravity, self.observer
        recipe = Recipe(method, run.methods, *known, self.rate_hz, *given, self._shared)
        return build_estimator(recipe)

    def columns(self, limb: str) -> NDArray[Any]:
        """Return the places of a limb's joints in a generalized velocity."""
        return self.description.layout.columns(self.description.layout.limb(limb))

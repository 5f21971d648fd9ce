"""The whole configuration, what follows from a row of it, and what a walk takes; other jobs take whole sections."""

from functools import cached_property
from typing import Annotated

from pydantic import Field

from mobnet.core.errors import ConfigError, not_accepted
from mobnet.core.joints import JointLayout
from mobnet.settings.base import (
    Index,
    LevelName,
    LimbNames,
    LowerName,
    MethodNames,
    RobotNetworkName,
    RowName,
    ScaleName,
    ScenarioName,
    Section,
    TestName,
)
from mobnet.settings.claims import Claim, ClaimName
from mobnet.settings.data import (
    Commands,
    Development,
    Motion,
    Push,
    RandomTorque,
    RecordingSettings,
    Scenario,
    Terrain,
    TrainingSet,
)
from mobnet.settings.detection import Detection
from mobnet.settings.evaluation import Evaluation
from mobnet.settings.methods import Method, Observer, Sweep
from mobnet.settings.networks import Learning, Network, NetworkRow, Training
from mobnet.settings.plant import Level, Plant, Rates
from mobnet.settings.published import Published
from mobnet.settings.robot import RobotTable
from mobnet.settings.scales import Experiment, Scale
from mobnet.settings.surrogate import Fleet, Surrogate
from mobnet.settings.trials import Trials, of_lengths, tuned
from mobnet.settings.walking import Walking


class Settings(Section):
    """Every number of the artifact, once; `seed` is the root of all random numbers, to which jobs add their names."""

    scale: ScaleName
    seed: Index
    rates: Rates
    plant: Plant
    levels: Annotated[dict[LowerName, Level], Field(min_length=1)]
    surrogate: Surrogate
    fleet: Fleet
    walking: Walking
    terrain: Terrain
    commands: Commands
    random_torque: RandomTorque
    motions: dict[LowerName, Motion]
    pushes: dict[LowerName, Push]
    scenarios: Annotated[dict[LowerName, Scenario], Field(min_length=1)]
    training_sets: Annotated[dict[LowerName, TrainingSet], Field(min_length=1)]
    recording: RecordingSettings
    observer: Observer
    networks: Annotated[dict[RobotNetworkName, NetworkRow], Field(min_length=1)]
    learning: Learning
    methods: Annotated[dict[RowName, Method], Field(min_length=1)]
    sweeps: dict[Annotated[str, Field(pattern="^[a-z_]+$")], Sweep]
    development: Development
    trials: Trials
    tests: dict[ScenarioName, Annotated[dict[LevelName, MethodNames], Field(min_length=1)]]
    estimated_limbs: dict[TestName, dict[LevelName, Annotated[LimbNames, Field(min_length=1)]]]
    detection: Detection
    evaluation: Evaluation
    scales: Annotated[dict[LowerName, Scale], Field(min_length=1)]
    robot: RobotTable
    published: Published
    claims: dict[ClaimName, Claim]

    @property
    def layout(self) -> JointLayout:
        """Joints and limbs of the robot."""
        return self.robot.layout

    @property
    def sizes(self) -> Scale:
        """The chosen scale."""
        return self.scales[self.scale]

    def test_s(self, scenario: str) -> float:
        """Return the duration of a test's recordings at the chosen scale [s]."""
        return self.sizes.durations_s.get(scenario, self.sizes.test.shard_s)

    @property
    def detection_walks(self) -> tuple[str, ...]:
        """The tests of the detectors of collisions; no errors are scored in them."""
        detection = self.detection
        return detection.collisions, detection.sweep, detection.place, detection.random

    def random_torque_of(self, scenario: str) -> RandomTorque:
        """Return the random torques of a scenario that has some: it may have its own largest one on legs and waist."""
        asked = self.scenarios[scenario].random_torque
        own = {} if isinstance(asked, bool) else {"legs_waist_nm": asked}
        return self.random_torque.model_copy(update=own)

    @cached_property
    def all_methods(self) -> dict[str, Method]:
        """The methods and those that sweeps stand for, such as `MOB-Net-hidden-44` (section 6.3)."""
        swept = {
            swept_name(base, key, value): _swept(self.methods[base], sweep, key, value)
            for key, sweep in self.sweeps.items()
            for base in sweep.of
            if base in self.methods
            for value in sweep.values
        }
        return {**self.methods, **swept}

    def sweep_of(self, method: str) -> str | None:
        """Return the sweep that stands for a method; None for a row of `methods`."""
        names = {
            swept_name(base, key, value): key
            for key, sweep in self.sweeps.items()
            for base in sweep.of
            for value in sweep.values
        }
        return names.get(method)

    @cached_property
    def tried(self) -> dict[str, Method]:
        """The methods of the trials, which no table shows."""
        trials = [*tuned(self.trials, self.methods), *of_lengths(self.trials, self.methods, self.learning.rate_first)]
        return {trial.name: trial.method for trial in trials}

    def method(self, name: str) -> Method:
        """Return a method, one of the trials too; a ConfigError names an unknown one."""
        if name in self.all_methods:
            return self.all_methods[name]
        if name not in self.tried:
            raise ConfigError(not_accepted("method", name, self.all_methods))
        return self.tried[name]

    def source_of(self, method: str) -> str:
        """Return the method whose fit a method runs on: the one that `of` names, or itself."""
        return self.method(method).of or method

    def network_source_of(self, method: str) -> str:
        """Return the method whose networks a method runs on: itself if it has some, else that of its fit."""
        return method if self.method(method).limbs else self.source_of(method)

    def predicted(self, method: str) -> tuple[str, ...]:
        """Return the joints that a method's own networks predict; none for a method without networks."""
        limbs = self.method(method).limbs
        return self.layout.limbs(group for limb in limbs for group in self.robot.networks[limb].joints)

    def estimated(self, method: str, scenario: str, level: str) -> tuple[str, ...]:
        """Return the joints that a method estimates in a test.

        A method with networks estimates those joints of the test's limbs that they predict, any other method all.
        """
        joints = self.layout.limbs(self.estimated_limbs.get(scenario, {}).get(level, self.layout.groups))
        known = self.predicted(self.network_source_of(method)) or self.layout.names
        return tuple(joint for joint in joints if joint in known)

    def network(self, method: str, limb: str) -> Network:
        """Return a network of Table 1 with a method's changes laid over it; a ConfigError names an unknown one."""
        if limb not in self.networks:
            raise ConfigError(not_accepted("network", limb, self.networks))
        row, ports = self.networks[limb], self.robot.networks[limb]
        return Network.model_validate({**vars(ports), **vars(row), **self.method(method).network})

    def experiment(self, method: str, limb: str) -> Experiment:
        """Return how long and how often a method's network is trained at the chosen scale."""
        return self.sizes.experiments[self.network(method, limb).experiment]

    def learned(self, method: str) -> Learning:
        """Return how a method's networks learn: the chosen scale's sizes, then its own changes, over `learning`."""
        scaled = {name: getattr(self.sizes, name) for name in ("batch_size", "stream_s", "rate_decay_share")}
        known = {name: value for name, value in scaled.items() if value is not None}
        return Learning.model_validate({**vars(self.learning), **known, **self.method(method).learning})

    def training(self, method: str, limb: str) -> Training:
        """Return all that a training of a method's network takes.

        Raises:
            ConfigError: the method is unknown or learns nothing, or the network is unknown.
        """
        row = self.method(method)
        if row.target is None:
            accepted = [name for name, other in self.all_methods.items() if other.target]
            raise ConfigError(not_accepted("method to train", method, accepted))
        experiment, network = self.experiment(method, limb), self.network(method, limb)
        return Training(
            method=method,
            limb=limb,
            target=row.target,
            network=network,
            learning=self.learned(method),
            epochs=experiment.epochs,
            epoch_samples=experiment.epoch_samples,
            held_out=self.training_sets[network.data].sizes[self.scale].held_out,
        )


class WalkSettings(Section):
    """A scenario at a level, with the terrains and pushes that it names and no others; recordings draw by its name."""

    seed: int
    robot: RobotTable
    rates: Rates
    plant: Plant
    walking: Walking
    commands: Commands
    random_torque: RandomTorque
    recording: RecordingSettings
    scenario_name: str
    scenario: Scenario
    level_name: str
    level: Level
    surrogate: Surrogate | None
    terrain: Terrain
    pushes: dict[str, Push]


def swept_name(base: str, key: str, value: int) -> str:
    """Return the name of the method that stands for one value of a sweep."""
    return f"{base}-{key.replace('_', '-')}-{value}"


def _swept(base: Method, sweep: Sweep, key: str, value: int) -> Method:
    """Return a method with a sweep's limb, experiment and changed key."""
    network, learning = {**base.network, "experiment": sweep.experiment}, dict(base.learning)
    (network if sweep.section == "network" else learning)[key] = value
    return base.model_copy(update={"limbs": (sweep.limb,), "network": network, "learning": learning})

"""What follows from the configuration: its tests, all methods with those of sweeps and trials, what each one learns."""

from collections import defaultdict
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import product

from experiments.settings.asked import RunRequest, asked_by
from experiments.settings.scales import Experiment
from experiments.settings.settings import Settings
from experiments.settings.trials import MethodVariant, compared, explained, taught, tuned
from mobnet.core.errors import ConfigError, not_accepted
from mobnet.core.joints import JointLayout
from mobnet.settings.methods import Method, Sweep, swept_name
from mobnet.settings.networks import Learning, Network, Training

Names = tuple[str, ...]
ByTest = Mapping[str, Mapping[str, Names]]  # scenario -> level -> names
Held = Mapping[tuple[str, str, str], Names]  # scenario, level and method -> limbs


@dataclass(frozen=True)
class Catalogue:
    """Answers about a configuration; tests and limbs are `given` where they are not those that it asks for itself."""

    settings: Settings
    given: tuple[ByTest, Held] | None = None

    @cached_property
    def layout(self) -> JointLayout:
        """The robot's joints and limbs, made once."""
        return self.settings.layout

    @cached_property
    def asked(self) -> tuple[RunRequest, ...]:
        """Every run that the configuration asks for."""
        return tuple(asked_by(self.settings))

    @property
    def tests(self) -> ByTest:
        """The methods that run in each test at each level."""
        return self._tests_and_limbs[0]

    @property
    def limbs(self) -> Held:
        """The limbs whose joints a method's estimates of a test at a level hold; only the networks of these limbs run.

        A method without networks holds what is shown of any method; all limbs where no network runs, as it costs
        nothing there.
        """
        return self._tests_and_limbs[1]

    @cached_property
    def _tests_and_limbs(self) -> tuple[ByTest, Held]:
        """The tests in the order of scenarios and levels, and the limbs of each of their methods."""
        if self.given:
            return self.given
        methods = defaultdict[tuple[str, str], set[str]](set)
        shown = defaultdict[tuple[str, str, str], set[str]](set)
        for request in self.asked:
            methods[request.scenario, request.level].add(request.method)
            shown[request.scenario, request.level, request.method].update(request.shown)
        tests: dict[str, dict[str, Names]] = {}
        limbs: dict[tuple[str, str, str], Names] = {}
        # In the configuration's order, so that no file depends on where a table or a claim stands in its own.
        for scenario, level in product(self.settings.scenarios, [*self.settings.levels, *self.settings.fleet.levels]):
            if (scenario, level) in methods:
                ran = self._in_order(methods[scenario, level])
                tests.setdefault(scenario, {})[level] = ran
                learned = [method for method in ran if self.method(self.network_source_of(method)).limbs]
                every = {name for method in ran for name in shown[scenario, level, method]}
                for method in ran:
                    of_method = shown[scenario, level, method] if method in learned else every
                    estimated_limbs = self._limbs_of(of_method) if learned else tuple(self.layout.groups)
                    limbs[scenario, level, method] = estimated_limbs
        return tests, limbs

    def at_scale(self, scale: str) -> "Catalogue":
        """Return the same at another scale."""
        return Catalogue(self.settings.model_copy(update={"scale": scale}), self._tests_and_limbs)

    def _in_order(self, names: Iterable[str]) -> Names:
        """Return methods in the order of the configuration, those that are nothing but networks after the others."""
        rows = self.all_methods
        order = {name: (bool(row.limbs) and row.of is None, k) for k, (name, row) in enumerate(rows.items())}
        return tuple(sorted((name for name in names if name in order), key=order.__getitem__))

    def _limbs_of(self, shown: set[str]) -> Names:
        """Return the limbs of some limbs or joints that are shown."""
        groups = self.layout.groups.items()
        return tuple(limb for limb, joints in groups if limb in shown or shown.intersection(joints))

    @cached_property
    def all_methods(self) -> dict[str, Method]:
        """The methods and those that sweeps stand for, such as `MOB-Net-hidden-44` (section 6.3)."""
        methods = self.settings.methods
        swept: dict[str, Method] = {}
        for key, sweep in self.settings.sweeps.items():
            for base in sweep.of:
                # The checks that tell of an unknown base ask for these methods, too.
                if base in methods:
                    for value in sweep.values:
                        swept[swept_name(base, key, value)] = _swept(methods[base], sweep, key, value)
        return {**methods, **swept}

    @cached_property
    def trials(self) -> tuple[MethodVariant, ...]:
        """Every variant that is tried."""
        given = self.settings.trials, self.settings.methods, self.settings.development
        return (*tuned(*given), *compared(*given), *taught(*given[:2]), *explained(*given[:2]))

    @cached_property
    def tried(self) -> dict[str, Method]:
        """The methods of the trials, which no table shows, each with the limbs of all tasks that it is tried at."""
        limbs: dict[str, dict[str, None]] = {}
        for trial in self.trials:
            limbs.setdefault(trial.name, {}).update(dict.fromkeys(trial.method.limbs))
        return {
            variant.name: variant.method.model_copy(update={"limbs": tuple(limbs[variant.name])})
            for variant in self.trials
        }

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

    def owner_of(self, method: str, limb: str) -> str:
        """Return the method whose network of a limb a method runs: its own, if it names no other one."""
        return self.method(method).networks_of.get(limb, method)

    def estimated(self, method: str, scenario: str, level: str) -> Names:
        """Return the joints that a method estimates in a test.

        A method with networks estimates those joints of the test's limbs that they predict, any other method all.
        """
        layout = self.layout
        networks = self.settings.robot.networks
        groups: list[str] = []
        for limb in self.method(self.network_source_of(method)).limbs:
            groups += networks[limb].joints
        known = layout.limbs(groups) or layout.names
        joints = layout.limbs(self.limbs.get((scenario, level, method), layout.groups))
        return tuple(joint for joint in joints if joint in known)

    def network(self, method: str, limb: str) -> Network:
        """Return a network of Table 1 with a method's changes laid over it; a ConfigError names an unknown one."""
        rows = self.settings.networks
        if limb not in rows:
            raise ConfigError(not_accepted("network", limb, rows))
        ports = self.settings.robot.networks[limb]
        owner = self.method(self.owner_of(method, limb))
        return Network.model_validate({**vars(ports), **vars(rows[limb]), **owner.network})

    def experiment(self, method: str, limb: str) -> Experiment:
        """Return how long and how often a method's network is trained at the chosen scale."""
        return self.settings.sizes.experiments[self.network(method, limb).experiment]

    def learned(self, method: str) -> Learning:
        """Return how a method's networks learn: the chosen scale's sizes, then its own changes, over `learning`."""
        sizes = self.settings.sizes
        scaled = {name: getattr(sizes, name) for name in ("batch_size", "stream_s", "rate_decay_share")}
        known = {name: value for name, value in scaled.items() if value is not None}
        return Learning.model_validate({**vars(self.settings.learning), **known, **self.method(method).learning})

    def training(self, method: str, limb: str) -> Training:
        """Return all that a training of a method's network takes.

        Raises:
            ConfigError: the method is unknown or learns nothing, or the network is unknown.
        """
        row = self.method(method)
        if row.target is None:
            accepted = [name for name, other in self.all_methods.items() if other.target]
            raise ConfigError(not_accepted("method to train", method, accepted))
        experiment = self.experiment(method, limb)
        network = self.network(method, limb)
        return Training(
            method=method,
            limb=limb,
            target=row.target,
            network=network,
            learning=self.learned(method),
            epochs=experiment.epochs,
            epoch_samples=experiment.epoch_samples,
            held_out=self.settings.training_sets[network.data].sizes[self.settings.scale].held_out,
        )


def _swept(base: Method, sweep: Sweep, key: str, value: int) -> Method:
    """Return a method with a sweep's limb, experiment and changed key."""
    network = {**base.network, "experiment": sweep.experiment}
    learning = dict(base.learning)
    (network if sweep.section == "network" else learning)[key] = value
    return base.model_copy(update={"limbs": (sweep.limb,), "network": network, "learning": learning})

"""Which recordings and networks a scale has, by their seeds, and how long recordings are."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Self

from experiments.settings.catalogue import Catalogue
from experiments.settings.fleet import OWN_TESTS, as_robot, is_whole
from experiments.settings.settings import Settings
from mobnet.core.errors import ConfigError
from mobnet.settings.data import Recordings

# Recordings and motions of development and of training count from these seeds; those of tests, from their scale's
# `first_seed`, lie below, and those of tests of robots of the fleet from `OWN_TESTS` on.
FIRST_DEVELOPMENT_SEED = 501
FIRST_TRAINING_SEED = 1000


@dataclass(frozen=True)
class Seeds:
    """Seeds and durations of the plant of section 5.1 or, by its name, of a robot of the fleet.

    Attributes:
        catalogue: the configuration, of a robot as it has it.
        results: folder of its files, beside those of the others.
        robot: its name; nothing for the plant of section 5.1.
        is_whole: whether it walks all tests, and not those of a leg alone.
        number: its place in the fleet, from 0; 0 also of the plant.
    """

    catalogue: Catalogue
    results: Path
    robot: str = ""
    is_whole: bool = True
    number: int = 0

    @property
    def settings(self) -> Settings:
        """The configuration, of a robot as it has it."""
        return self.catalogue.settings

    @cached_property
    def robots(self) -> Mapping[str, Self]:
        """Robot of the fleet -> its files; of a robot itself there are none."""
        settings = self.settings
        robots: dict[str, Self] = {}
        for number, name in enumerate(settings.fleet.robots[: settings.sizes.fleet]):
            catalogue = as_robot(self.catalogue, name)
            robots[name] = type(self)(catalogue, self.shared / name, name, is_whole(settings, name), number)
        return robots

    @property
    def whole_robots(self) -> Mapping[str, Self]:
        """Robot of the fleet that walks all tests -> its files."""
        return {name: files for name, files in self.robots.items() if files.is_whole}

    @property
    def shared(self) -> Path:
        """Folder of what all robots share: motions, scores, and a folder for each of them."""
        return self.results.parent

    @property
    def owners(self) -> tuple[Self, ...]:
        """These and those of each robot of the fleet."""
        return self, *self.robots.values()

    def has(self, level: str) -> bool:
        """Return whether a level is one of these files' own: of a robot, or of the plant of section 5.1."""
        fleet = self.settings.fleet
        if self.robot:
            known = fleet.levels if self.is_whole else (fleet.name,)
            return level in (*known, *(fleet.level_of(self.robot, name) for name in known))
        return level in self.settings.levels and level not in fleet.robots

    @property
    def test_seeds(self) -> list[int]:
        """Seeds of the test recordings, the same in every test; each robot has its own."""
        test = self.settings.sizes.test
        return [test.first_seed + i for i in range(test.shards)]

    def training_seeds(self, name: str) -> list[int]:
        """Return the seeds of a training set's recordings."""
        return [FIRST_TRAINING_SEED + i for i in range(self.training_size(name).shards)]

    def training_size(self, name: str) -> Recordings:
        """Return number and duration of a training set's recordings."""
        return self.settings.training_sets[name].sizes[self.settings.scale]

    def training_s(self, name: str) -> float:
        """Return the duration of a training set [s]."""
        size = self.training_size(name)
        return size.shards * size.shard_s

    def learned_steps(self, method: str, limb: str) -> float:
        """Return the time steps that a network learns from, over all epochs; 0 of one without inputs."""
        training = self.catalogue.training(method, limb)
        network = training.network
        if not (network.Q or network.T):
            return 0.0
        read = self.training_s(network.data) * self.settings.rates.data_hz / training.learning.data_parts
        return training.epochs * (training.epoch_samples or read)

    def seeds_of(self, scenario: str, level: str) -> list[int]:
        """Return the seeds of a set of recordings: no scenario and level serve tests, development and training alike.

        Training sets of one scenario at one level count from the same seed: the largest of them has all recordings.

        Raises:
            ConfigError: nothing is recorded of the scenario at the level.
        """
        if level in self.catalogue.tests.get(scenario, ()):
            return self.test_seeds
        walks = self.settings.development.values()
        trial = self.settings.trials.factorial
        developed = [(walk.scenario, walk.level) for walk in walks]
        developed += [(walk, self.robot) for walk in (trial.walk, trial.hits)]
        why = self.settings.trials.why
        developed += [(why.twin, self.robot)]
        for row in self.settings.training_sets.values():
            developed += [(walk, row.level) for walk in (why.walk, why.hits)]
        if (scenario, level) in developed:
            return list(self.development_seeds)
        longest: list[int] = []
        for name, row in self.settings.training_sets.items():
            seeds = self.training_seeds(name)
            if (row.scenario, row.level) == (scenario, level) and len(seeds) > len(longest):
                longest = seeds
        if not longest:
            raise ConfigError(f"{scenario} at level {level}: no test, training or trial of the configuration has it")
        return longest

    @property
    def development_seeds(self) -> range:
        """Seeds of the walks on which methods are chosen; each robot has its own."""
        shards = self.settings.sizes.development.shards
        first = FIRST_DEVELOPMENT_SEED + self.number * shards
        return range(first, first + shards)

    def duration_s(self, scenarios: Iterable[str], seed: int, level: str = "") -> float:
        """Return the duration of the recordings with a seed [s]; of several scenarios, or at any level, the longest."""
        wanted = list(scenarios)
        sets = self.settings.training_sets
        if seed < FIRST_DEVELOPMENT_SEED or seed >= OWN_TESTS:
            return max(self.settings.test_s(name) for name in wanted)
        if seed < FIRST_TRAINING_SEED:
            return self.settings.sizes.development.shard_s
        learned = [name for name, row in sets.items() if row.scenario in wanted and level in ("", row.level)]
        return max(self.training_size(name).shard_s for name in learned)

    def set_s(self, scenario: str, level: str) -> float:
        """Return the duration of all recordings of a set [s]."""
        seeds = self.seeds_of(scenario, level)
        return len(seeds) * self.duration_s([scenario], seeds[0], level)

    def motion_s(self, motion: str, seed: int) -> float:
        """Return the duration of a motion [s]: that of the longest recording that takes it."""
        moved = [name for name, row in self.settings.scenarios.items() if row.motion == motion]
        return self.duration_s(moved, seed)

    def network_seeds(self, method: str, limb: str | None = None) -> tuple[int, ...]:
        """Return the seeds of a method's networks of a limb, or of that with the most; (0,) if there are none."""
        limbs = [limb] if limb else self.catalogue.method(self.catalogue.network_source_of(method)).limbs
        return max((self.catalogue.experiment(method, name).seeds for name in limbs), key=len, default=(0,))

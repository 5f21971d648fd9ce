"""Where the files of recordings, residuals, estimates and networks stand, and which of them are made."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, fields, is_dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import NamedTuple, cast

from experiments.plan.runs import Run, SweptSize
from experiments.plan.seeds import Seeds
from experiments.settings.asked import asked_in
from experiments.settings.fleet import FIRST_SEED
from experiments.settings.runs import Runs
from mobnet.core.files import METRICS, RUN, WEIGHTS
from mobnet.settings.methods import swept_name, swept_names

ARRAY, NOTE = ".parquet", ".json"  # endings of the two files of an array
TRAINED = (WEIGHTS, METRICS, RUN)  # files of a trained network
PLANT = "plant"  # folder of the plant of section 5.1
SETS = ("recordings", "residuals", "estimates")  # folders of sets, ROBOT/KIND/SCENARIO/LEVEL
NETWORKS = "networks"
Place = tuple[str, str, int]  # of a recording: scenario, level and seed


class NetworkName(NamedTuple):
    """A network that is trained: method, limb and seed."""

    method: str
    limb: str
    seed: int


@dataclass(frozen=True)
class Files(Seeds):
    """Where the files of a scale stand; tables, figures and the paper stand elsewhere.

    The plant of section 5.1 and each robot of the fleet have a folder of their own, beside what all share. A set of
    recordings, of residuals or of estimates is a folder, and one job makes it.
    """

    def array(self, kind: str, scenario: str, level: str, seed: int) -> Path:
        """Return a recording or residual without its ending."""
        return self.results / kind / scenario / level / f"s{seed}"

    def estimate(self, scenario: str, level: str, method: str, network_seed: int, seed: int) -> Path:
        """Return what a method with the networks of a seed estimates of a recording, without its ending."""
        return self.results / "estimates" / scenario / level / method / f"n{network_seed}" / f"s{seed}"

    def motion(self, scenario: str, seed: int) -> list[Path]:
        """Return the motion of the upper body in a recording; none where it is still."""
        name = self.settings.scenarios[scenario].motion
        return [self.motion_place(name, seed)] if name else []

    def motion_place(self, motion: str, seed: int) -> Path:
        """Return a motion of the upper body, which all robots share."""
        return self.shared / "motions" / motion / f"s{seed}"

    def training(self, kind: str, name: str) -> tuple[Path, ...]:
        """Return the recordings or residuals of a training set, of all robots that learn from it where it is theirs."""
        row = self.settings.training_sets[name]
        if row.level not in self.settings.fleet.levels:
            return tuple(self.array(kind, row.scenario, row.level, seed) for seed in self.training_seeds(name))
        # A set of the whole fleet is recorded by each robot on its own, below the robot's folder and by its own name.
        robot_set = next(robot_set for robot_set, other in self.settings.fleet.sets.items() if other == name)
        paths: list[Path] = []
        for files in self.robots.values():
            if robot_set in files.learned_sets:
                paths += files.training(kind, robot_set)
        return tuple(paths)

    def tests(self, scenario: str, level: str, kind: str = "recordings") -> tuple[Path, ...]:
        """Return the recordings of a test, or their residuals."""
        return tuple(self.array(kind, scenario, level, seed) for seed in self.test_seeds)

    def development(self, kind: str, task: str) -> tuple[Path, ...]:
        """Return the recordings or residuals of the walks on which methods are chosen; no table shows them."""
        walk = self.settings.development[task]
        return tuple(self.array(kind, walk.scenario, walk.level, seed) for seed in self.development_seeds)

    @property
    def falls(self) -> Path:
        """File of the falls of a robot in the trial of random torques."""
        return self.results / "falls.csv"

    def recorded(self) -> Iterator[Place]:
        """Yield scenario, level and seed of every recording but those of robots of the fleet."""
        for name in self.recorded_sets:
            row = self.settings.training_sets[name]
            yield from ((row.scenario, row.level, seed) for seed in self.training_seeds(name))
        for scenario, levels in self.catalogue.tests.items():
            for level in filter(self.has, levels):
                yield from ((scenario, level, seed) for seed in self.test_seeds)

    def run_seeds(self, method: str, scenario: str, level: str) -> tuple[int, ...]:
        """Return the seeds with which a method runs in a test: those of the limb with the most among the test's."""
        every = self.network_seeds(method)
        if scenario in self.settings.detection_walks:
            return every[:1]  # a robot detects with one network
        source = self.catalogue.network_source_of(method)
        limbs = self.networks(method, every[0], scenario, level)
        return max((self.network_seeds(source, limb) for limb in limbs), key=len, default=every)

    def network(self, method: str, limb: str, seed: int) -> Path:
        """Return the folder of a trained network; a limb with fewer seeds than others serves them in turn."""
        method = self.catalogue.owner_of(method, limb)
        seeds = self.network_seeds(method, limb)
        return self.results / NETWORKS / f"{method}-{limb}-s{seeds[seed % len(seeds)]}"

    def networks(self, method: str, seed: int, scenario: str, level: str) -> dict[str, Path]:
        """Return the networks, limb -> folder, that a method runs in a test: those of joints that it estimates."""
        source = self.catalogue.network_source_of(method)
        joints = {*self.catalogue.estimated(method, scenario, level)}
        return {
            limb: self.network(source, limb, seed)
            for limb in self.catalogue.method(source).limbs
            if joints.intersection(self.settings.layout.limbs(self.settings.robot.networks[limb].joints))
        }

    def repeated(self, method: str, seed: int) -> tuple[str, ...]:
        """Return the limbs, groups of joints, whose network served an earlier seed of a method already."""
        source = self.catalogue.network_source_of(method)
        seeds = self.network_seeds(method)
        earlier = seeds[: seeds.index(seed)]
        networks = self.settings.robot.networks
        joints: list[str] = []
        for limb in self.catalogue.method(source).limbs:
            served = [self.network(source, limb, other) for other in earlier]
            if self.network(source, limb, seed) in served:
                joints += networks[limb].joints
        return tuple(joints)

    def network_folders(self, methods: Iterable[str], limb: str, level: str) -> tuple[Path, ...]:
        """Return the folders of methods' networks of a limb trained at a level, on a fleet those of each robot."""
        folders: list[Path] = []
        for name in methods:
            for files in self.owners:
                # A level of the fleet is every robot's, any other one belongs to a single owner.
                if files.is_whole and files.has(level):
                    folders += [files.network(name, limb, seed) for seed in files.network_seeds(name, limb)]
        return tuple(folders)

    @cached_property
    def learned(self) -> frozenset[tuple[str, str]]:
        """Method and limb of every network that runs in a test or is shown by itself."""
        catalogue = self.catalogue
        settings = self.settings
        evaluation = self.settings.evaluation
        pairs: list[tuple[str, str]] = []
        for scenario, levels in catalogue.tests.items():
            for level in filter(self.has, levels):
                for method in levels[level]:
                    source = catalogue.network_source_of(method)
                    # Seeds repeat a training and have the same limbs, so that the first one tells them.
                    limbs = self.networks(method, self.network_seeds(method)[0], scenario, level)
                    pairs += [(catalogue.owner_of(source, limb), limb) for limb in limbs]
        kinds = evaluation.figure_17
        sizes = evaluation.figure_20
        timed = evaluation.latency.method
        if self.is_whole and self.has(kinds.level):
            pairs += [(method, kinds.limb) for method in kinds.methods]
        if self.has(kinds.best_level):
            pairs += [(method, kinds.limb) for method in kinds.best]
        if self.has(evaluation.kinds.level):
            pairs += [(method, kinds.limb) for method in evaluation.kinds.variants]
        if self.has(sizes.level):
            for key in (sizes.parameters, sizes.samples):
                pairs += [(name, sizes.limb) for name in swept_names(key, settings.sweeps[key])]
        # What a network takes of a tick is measured once, with networks of the plant.
        if not self.robot:
            pairs += [(catalogue.owner_of(timed, limb), limb) for limb in catalogue.method(timed).limbs]
        # A fine-tuned network begins with the weights of another one, which is trained even if nothing shows it.
        pairs += [(first, limb) for method, limb in pairs if (first := catalogue.method(method).start)]
        return frozenset(pairs)

    @cached_property
    def own_networks(self) -> tuple[NetworkName, ...]:
        """The networks that are trained of the plant of section 5.1, or of a robot."""
        names: list[NetworkName] = []
        for method, row in self.catalogue.all_methods.items():
            for limb in row.limbs:
                if (method, limb) in self.learned:
                    names += [NetworkName(method, limb, seed) for seed in self.network_seeds(method, limb)]
        return tuple(names)

    def all_networks(self) -> tuple[Path, ...]:
        """Return the folders of every network that is trained, those of robots last."""
        return tuple(files.network(*name) for files in self.owners for name in files.own_networks)

    @cached_property
    def learned_sets(self) -> tuple[str, ...]:
        """Names of the training sets that networks and fits learn from, in the configuration's order."""
        settings = self.settings
        catalogue = self.catalogue
        named = {method for method, _ in self.learned}
        for levels in catalogue.tests.values():
            for methods in levels.values():
                named.update(methods)
        used = {catalogue.network(method, limb).data for method, limb in self.learned}
        # A fit learns from the sets from which networks of its limbs would learn.
        for source in set(map(catalogue.source_of, named)):
            used.update(catalogue.network(source, limb).data for limb in catalogue.method(source).fitted)
        return tuple(name for name in settings.training_sets if name in used)

    @property
    def recorded_sets(self) -> tuple[str, ...]:
        """Names of the training sets that are recorded: all of the plant of section 5.1, of a robot those it needs."""
        sets = self.settings.training_sets
        return self.learned_sets if self.robot else tuple(name for name, row in sets.items() if self.has(row.level))

    def fit(self, method: str) -> list[Path]:
        """Return the file of what a method, or the one it runs on, was fitted to; none if it is not fitted."""
        source = self.catalogue.source_of(method)
        return [self.results / "fits" / f"{source}.json"] if self.catalogue.method(source).fitted else []

    def start(self, method: str, limb: str, seed: int) -> Path | None:
        """Return the weights from which a method's network is fine-tuned; None of one that learns from the first."""
        first = self.catalogue.method(method).start
        return self.network(first, limb, seed) / WEIGHTS if first else None

    def runs(self, scenario: str, level: str, methods: Iterable[str]) -> tuple[Run, ...]:
        """Return the runs of methods on a test: every network on every recording; on a fleet, those of each robot."""
        fleet = self.settings.fleet
        runs: list[Run] = []
        if self.has(level):
            for method in methods:
                for network in self.run_seeds(method, scenario, level):
                    runs += self._runs_of(scenario, level, method, network)
            return tuple(runs)
        for seed, (robot, files) in enumerate(self.robots.items(), start=FIRST_SEED):
            if level in (*fleet.levels, robot):
                walked = fleet.level_of(robot, level)
                named = tuple(methods)
                if not files.is_whole:
                    known = files.catalogue.tests.get(scenario, {}).get(walked, ())
                    named = tuple(method for method in named if method in known)
                of_robot = files.runs(scenario, walked, named)
                # Every method has the robot's seed, also one without networks: methods are paired over robots.
                runs += [replace(run, level=level, network_seed=seed) for run in of_robot]
        return tuple(runs)

    def _runs_of(self, scenario: str, level: str, method: str, network_seed: int) -> Iterator[Run]:
        """Yield the runs of a method with the networks of a seed on every recording of a test."""
        repeated = self.repeated(method, network_seed)
        for seed in self.test_seeds:
            recording = self.array("recordings", scenario, level, seed)
            residual = self.array("residuals", scenario, level, seed)
            estimate = self.estimate(scenario, level, method, network_seed, seed)
            yield Run(scenario, level, method, network_seed, seed, recording, residual, estimate, repeated)

    def first_runs(self, test: Runs) -> tuple[Run, ...]:
        """Return the runs of a test that a figure of one recording shows: first network or robot, first recording."""
        return tuple(self.runs(test.scenario, test.level, [method])[0] for method in test.methods)

    def scored_runs(self, scenario: str, level: str) -> tuple[Run, ...]:
        """Return the runs of a test at a level whose errors a product shows; detectors have others."""
        if (scenario, level) not in self._scored:  # asked for by inputs, parameters and price of a job
            methods = [name for name in self.catalogue.tests[scenario][level] if (scenario, level, name) in self._shown]
            self._scored[scenario, level] = self.runs(scenario, level, methods)
        return self._scored[scenario, level]

    @property
    def scored(self) -> tuple[tuple[str, str], ...]:
        """The tests and levels whose errors are scored: those that a product shows, not those of detectors alone."""
        shown = {(scenario, level) for scenario, level, _ in self._shown}
        pairs: list[tuple[str, str]] = []
        for scenario, levels in self.catalogue.tests.items():
            pairs += [(scenario, level) for level in levels if (scenario, level) in shown]
        return tuple(pairs)

    @cached_property
    def _scored(self) -> dict[tuple[str, str], tuple[Run, ...]]:
        """Test and level -> the runs whose errors are scored, as far as they were asked for."""
        return {}

    @cached_property
    def _shown(self) -> frozenset[tuple[str, str, str]]:
        """Scenario, level and method of the runs that products show."""
        sections = self.settings.evaluation, self.settings.claims
        return frozenset((asked.scenario, asked.level, asked.method) for asked in asked_in(self.settings, sections, ()))

    def scores(self, shown: Iterable[tuple[str, str]]) -> tuple[Path, ...]:
        """Return the files of scores of some tests, each at a level; each file once."""
        return tuple(self.shared / "scores" / scenario / f"{level}.csv" for scenario, level in dict.fromkeys(shown))

    def swept_sizes(self) -> tuple[SweptSize, ...]:
        """Return the sizes of Figure 20; the network of all data is that of Table 1's size."""
        figure = self.settings.evaluation.figure_20
        sweeps = self.settings.sweeps
        sizes: list[SweptSize] = []
        for panel, key in (("parameters", figure.parameters), ("samples", figure.samples)):
            for base in sweeps[key].of:
                names = [swept_name(base, key, value) for value in sweeps[key].values]
                if panel == "samples":
                    full = getattr(self.catalogue.network(base, figure.limb), figure.parameters)
                    names.append(swept_name(base, figure.parameters, full))
                sizes += [
                    SweptSize(panel, base, self.network_folders([name], figure.limb, figure.level)) for name in names
                ]
        return tuple(sizes)


def made_by_jobs(needs: object) -> list[str]:
    """Return what jobs make of the files behind some arguments: the folder of a set in place of the files in it."""
    names: dict[str, None] = {}
    for path in files_in(needs):
        kind = next((place for place, part in enumerate(path.parts) if part in SETS), None)
        made = path if kind is None else Path(*path.parts[: kind + len(("kind", "scenario", "level"))])
        names[str(made)] = None
    return list(names)


def files_in(needs: object) -> Iterator[Path]:
    """Yield every file behind what a product needs, at any depth of containers and dataclasses."""
    if isinstance(needs, Path):
        yield from _files_of(needs)
        return
    items: list[object] = []
    if isinstance(needs, dict):
        items = list(cast("dict[object, object]", needs).values())
    elif isinstance(needs, list | tuple):
        items = list(cast("Sequence[object]", needs))
    elif is_dataclass(needs):
        items = [getattr(needs, field.name) for field in fields(needs)]
    for item in items:
        yield from files_in(item)


def _files_of(place: Path) -> Iterator[Path]:
    """Yield the files of a place: a file, those of a trained network, or an array."""
    if place.suffix:
        yield place
    elif place.parent.name == NETWORKS:
        yield from (place / name for name in TRAINED)
    else:
        yield place.with_suffix(ARRAY)

"""What the rules read, as sheets: a row for each set, network, test or product, with a column for each kind of file.

Rules look up what their wildcards name, and `./reproduce sheet NAME` prints a sheet. A set, a network or another file
of one robot is named `ROBOT/NAME`, what all robots share by its name alone. The rule says where such a file is.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from types import SimpleNamespace
from typing import Any, NamedTuple

from experiments.plan.detection import level_of_detectors
from experiments.plan.files import ARRAY, NETWORKS, SETS, Files, made_by_jobs
from experiments.plan.plan import Plan
from experiments.plan.product import Folders
from experiments.plan.sets import networks_of
from experiments.plan.stacks import Stacked
from experiments.running.words import SHEETS

SHARED = ("scores", "motions", "stacks")  # folders of what all robots share, each a column
OWN = {"fits": "fits", "detection": "detections", "reactions": "reactions"}  # folder of a robot -> column of its files
COLUMNS = (*SETS, *SHARED, NETWORKS, *OWN.values(), "courses", "falls", "tables", "files")


class Own(NamedTuple):
    """What a robot, or the plant of section 5.1, has of its own: a set by scenario and level, or a file by its name."""

    robot: str
    name: str

    def __str__(self) -> str:
        """Return it as a sheet prints it."""
        return f"{self.robot}/{self.name}"


Row = Mapping[str, Sequence[Any]]  # column -> names of files, each once; `seeds` are those of the recordings read


@dataclass(frozen=True)
class Sheet(Mapping[str, Row]):
    """A sheet: a row by its name.

    A row is worked out when somebody asks for it: a call for one table needs few of them.

    Attributes:
        names: returns the names of its rows.
        row: returns the row of a name.
    """

    names: Callable[[], Iterable[str]]
    row: Callable[[str], Row]

    @cached_property
    def _known(self) -> dict[str, Row]:
        return {}

    def __getitem__(self, name: str) -> Row:
        """Return the row of a name."""
        if name not in self._known:
            self._known[name] = self.row(name)
        return self._known[name]

    def __iter__(self) -> Iterator[str]:
        """Yield the names of the rows."""
        return iter(self.names())

    def __len__(self) -> int:
        """Return the number of rows."""
        return len(list(self.names()))


@dataclass(frozen=True)
class Sheets:
    """The sheets of a plan."""

    plan: Plan

    @property
    def all(self) -> dict[str, Sheet]:
        """Every sheet by its name."""
        return {name: getattr(self, name) for name in SHEETS}

    @cached_property
    def sets(self) -> Sheet:
        """Recordings, ROBOT/SCENARIO/LEVEL: their seeds, and the motions of the upper body that they take."""
        jobs = self.plan.jobs

        def row(name: str) -> Row:
            w = named("robot/scenario/level", name)
            return {"seeds": jobs.files(w).seeds_of(w.scenario, w.level), **self._read(jobs.motions(w))}

        def names() -> Iterator[str]:
            for files in self.plan.files.owners:
                yield from dict.fromkeys(_of(files, f"{scenario}/{level}") for scenario, level, _ in files.recorded())

        return Sheet(names, row)

    @cached_property
    def fits(self) -> Sheet:
        """Fits, ROBOT/METHOD."""
        jobs = self.plan.jobs

        def names() -> Iterator[str]:
            for files in self.plan.files.owners:
                fitted = dict.fromkeys(path.stem for path in networks_of(files) if path.suffix)
                yield from (_of(files, method) for method in fitted)

        return Sheet(names, lambda name: self._read(jobs.fit(named("robot/method", name))["training"]))

    @cached_property
    def networks(self) -> Sheet:
        """Networks, ROBOT/METHOD-LIMB-sSEED: what each learns from, and a network whose weights it begins with."""
        jobs = self.plan.jobs

        def row(name: str) -> Row:
            robot, network = name.split("/")
            method, limb, seed = network.rsplit("-", 2)
            w = SimpleNamespace(robot=robot, method=method, limb=limb, seed=seed.removeprefix("s"))
            read = jobs.learned_from(w)
            return {"seeds": seeds_in(read["recordings"]), **self._read([read, jobs.train(w).get("lesson")])}

        def names() -> Iterator[str]:
            for files in self.plan.files.owners:
                yield from (Stacked(files.results.name, network).name for network in files.own_networks)

        return Sheet(names, row)

    @cached_property
    def stacks(self) -> Sheet:
        """Networks that learn side by side, by the first of them."""
        jobs = self.plan.jobs
        return Sheet(lambda: jobs.stacks.members, lambda name: self._read(jobs.read_by_stack(named("stack", name))))

    @cached_property
    def tests(self) -> Sheet:
        """Tests, ROBOT/SCENARIO/LEVEL: the networks and fits of the methods that run in them."""
        jobs = self.plan.jobs

        def row(name: str) -> Row:
            w = named("robot/scenario/level", name)
            return {"seeds": jobs.files(w).test_seeds, **self._read(jobs.estimate(w)["runs"])}

        def names() -> Iterator[str]:
            for files in self.plan.files.owners:
                for scenario, levels in files.catalogue.tests.items():
                    yield from (_of(files, f"{scenario}/{level}") for level in levels if files.has(level))

        return Sheet(names, row)

    @cached_property
    def scores(self) -> Sheet:
        """Scores, SCENARIO/LEVEL."""
        jobs = self.plan.jobs

        def row(name: str) -> Row:
            return self._read(jobs.score(named("scenario/level", name))["runs"])

        return Sheet(lambda: map("/".join, self.plan.files.scored), row)

    @cached_property
    def detectors(self) -> Sheet:
        """Detectors, ROBOT: the walks on which they are calibrated and tried."""
        jobs = self.plan.jobs
        return Sheet(self._with_detectors, lambda name: self._read(jobs.detect(named("robot", name))["walks"]))

    @cached_property
    def watched(self) -> Sheet:
        """Limbs that are watched all the time, ROBOT: the walks from which their thresholds follow, and networks."""
        jobs = self.plan.jobs

        def row(name: str) -> Row:
            w = named("robot", name)
            quiet = jobs.quiet(w)
            return {"seeds": seeds_in(quiet), **self._read([quiet, jobs.watch(w)["runs"]])}

        return Sheet(self._with_detectors, row)

    @cached_property
    def reactions(self) -> Sheet:
        """Reactions, ROBOT/CASE: the networks and fits of what runs in the loop with the robot."""
        jobs = self.plan.jobs

        def names() -> Iterator[str]:
            for robot in self._with_detectors():
                yield from (f"{robot}/{case}" for case in self.plan.settings.reaction.cases)

        return Sheet(names, lambda name: self._read(jobs.react(named("robot/case", name))["runs"]))

    @cached_property
    def shown(self) -> Sheet:
        """Tables, figures and texts by their names."""
        plan = self.plan
        return Sheet(lambda: plan.names, lambda name: columns(plan.product(name).inputs, plan.folders))

    def _with_detectors(self) -> list[str]:
        """Return the plant of section 5.1 or the robots whose detectors are tried."""
        return [files.results.name for files in self.plan.files.owners if level_of_detectors(files)]

    def _read(self, needs: object) -> Row:
        """Return the row of the files behind what a job needs."""
        return columns(made_by_jobs(needs), self.plan.folders)


def _of(files: Files, name: str) -> str:
    """Return the name of a row of a robot's own."""
    return f"{files.results.name}/{name}"


def named(wildcards: str, name: str) -> Any:
    """Return the wildcards, as ROBOT/METHOD, that the name of a row stands for."""
    return SimpleNamespace(**dict(zip(wildcards.split("/"), name.split("/"), strict=True)))


def seeds_in(recordings: Iterable[Path]) -> list[list[int]]:
    """Return the seeds of recordings, set by set."""
    sets: dict[Path, list[int]] = {}
    for recording in recordings:
        sets.setdefault(recording.parent, []).append(int(recording.name.removeprefix("s")))
    return list(sets.values())


def columns(made: Iterable[str], folders: Folders) -> Row:
    """Return the columns of files that jobs make, and of those of the project."""
    names_in: dict[str, dict[Any, None]] = {column: {} for column in COLUMNS}
    for file in made:
        column, name = place_of(Path(file), folders)
        names_in[column][name] = None
    return {column: list(names) for column, names in names_in.items()}


def place_of(file: Path, folders: Folders) -> tuple[str, object]:
    """Return the column of a file, and its name there."""
    if file.parent == folders.tables and file.suffix == ".csv":
        return "tables", file.stem
    if not file.is_relative_to(folders.results):
        return "files", str(file)
    first, *below = file.relative_to(folders.results).parts
    if first in SHARED:
        return first, str(Path(*below).with_suffix(""))
    if below == ["falls.csv"]:
        return "falls", first
    if below and below[0] in SETS:
        return below[0], Own(first, "/".join(below[1:]))
    if below and below[0] == NETWORKS:
        return NETWORKS, Own(first, below[1])
    if below and below[0] in OWN:
        return "courses" if file.suffix == ARRAY else OWN[below[0]], Own(first, file.stem)
    return "files", str(file)

"""The seeds whose walks published results have shown, and what a further run may walk.

Whoever has seen the results of some seeds and then changes a method may have fitted it to them. A run whose methods
differ from those of a published one therefore walks its tests with seeds that no published run has walked.
"""

import hashlib
import json
from collections.abc import Iterable, Sequence
from itertools import chain
from pathlib import Path

from pydantic import Field

from experiments.plan.detection import level_of_detectors
from experiments.plan.files import Files
from experiments.plan.reactions import sizes_of
from experiments.settings.fleet import OWN_TESTS
from experiments.settings.settings import Settings
from mobnet.core.code import SHORT, SOURCE, source_hash
from mobnet.core.errors import DataError, misfit
from mobnet.core.files import write_json
from mobnet.core.notes import Count, Index, Note, Text, read_note

SEEDS = Path("docs/results/seeds.json")
KINDS = "mobnet/estimation/kinds"
CODE = (  # what learns, estimates, detects and reacts; the modules of estimators, which are imported by name, are added
    "experiments.jobs.trainings",
    "experiments.jobs.estimates",
    "mobnet.detection.calibrate",
    "experiments.jobs.detect",
    "experiments.jobs.calm",
    "experiments.jobs.react",
)
# Sections that change no method: what is shown, printed and claimed, trials apart from the published results, what
# belongs to other robots, and the scales, of which the lengths of trainings are added.
NO_METHOD = {
    "scale",
    "scales",
    "evaluation",
    "published",
    "claims",
    "trials",
    "development",
    "robotlog",
    "free_motion",
}
LENGTHS = ("experiments", "robots", "least_swings", "batch_size", "stream_s", "rate_decay_share")


class Span(Note):
    """The seeds of a test: the first one and how many follow each other."""

    first: Index
    count: Count

    @property
    def seeds(self) -> range:
        """All of them."""
        return range(self.first, self.first + self.count)


class WalkedSeeds(Note):
    """What a run has walked.

    Attributes:
        commit: of the run.
        methods: hash of the methods' code and configuration; None of runs from before it was noted.
        same: hashes of code that was only ordered anew since then, with every result of the smoke scale equal to the
            byte. A person adds them.
        tests: scenario -> seeds, of the plant or the robot that walks most.
        reactions: case of the reactions -> seeds.
    """

    commit: Text
    methods: Text | None
    same: list[Text] = Field(default_factory=list)
    tests: dict[str, Span]
    reactions: dict[str, Span]

    @property
    def seeds(self) -> frozenset[int]:
        """The seeds of all tests."""
        spans = [*self.tests.values(), *self.reactions.values()]
        return frozenset(chain.from_iterable(span.seeds for span in spans))


class History(Note):
    """The published runs, the oldest one first."""

    runs: list[WalkedSeeds]


def read_history(path: Path) -> list[WalkedSeeds]:
    """Return the published runs, the oldest one first.

    Raises:
        DataError: the file is missing or damaged, or a key or a value is not accepted.
    """
    return read_note(path, History).runs


def write_history(path: Path, runs: Sequence[WalkedSeeds]) -> None:
    """Write the published runs; of two of the same commit the later one is kept."""
    by_commit = {run.commit: run for run in runs}
    write_json(path, History(runs=list(by_commit.values())).model_dump())


def walked(files: Files, commit: str) -> WalkedSeeds:
    """Return what a run of the chosen scale walks at a commit."""
    tests: dict[str, Span] = {}
    for owner in files.owners:
        for scenario, levels in owner.catalogue.tests.items():
            if any(owner.has(level) for level in levels):
                # A robot may walk fewer recordings of a test than another, or than the plant: the most count.
                others = tests[scenario].count if scenario in tests else 0
                count = max(len(owner.test_seeds), others)
                # Robots count from the same number as the plant, each in a range of its own.
                tests[scenario] = Span(first=owner.test_seeds[0] % OWN_TESTS, count=count)
    reactions: dict[str, Span] = {}
    if any(level_of_detectors(owner) for owner in files.owners):
        for case in files.settings.reaction.cases:
            first = files.settings.sizes.test.first_seed
            reactions[case] = Span(first=first, count=sizes_of(files, case).runs)
    return WalkedSeeds(commit=commit, methods=methods_hash(files.settings), tests=tests, reactions=reactions)


def methods_hash(settings: Settings) -> str:
    """Return a short hash of what makes the methods: their code, and the configuration without what is only shown."""
    written = settings.model_dump(mode="json", exclude=NO_METHOD)
    lengths = settings.sizes.model_dump(mode="json", include=set(LENGTHS))
    kinds = sorted((SOURCE / KINDS).glob("*.py"))
    text = json.dumps([written, lengths, source_hash(*CODE, *kinds)], sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()[:SHORT]


def check_seeds(run: WalkedSeeds, published: Iterable[WalkedSeeds]) -> None:
    """Check that a run walks no seed of a published run whose methods were others.

    Raises:
        DataError: it would; one line, with the seeds of the last such run and the remedy.
    """
    published = list(published)
    # Nobody knows the methods of runs from before these were noted: they count as others.
    others = [other for other in published if other.methods is None or run.methods not in (other.methods, *other.same)]
    seen = [other for other in others if other.seeds & run.seeds]
    if seen:
        used: set[int] = set()
        for other in published:
            used |= other.seeds
        both = sorted(seen[-1].seeds & run.seeds)
        shown = f"{both[0]} to {both[-1]} were published by {seen[-1].commit[:8]}, whose methods were others"
        accepted = f"a first_seed in configs/scales.yaml from {max(used) + 1} on, or another one that was never walked"
        raise DataError(f"seeds of the tests: {misfit(min(run.seeds), f'{accepted}; {shown}')}")

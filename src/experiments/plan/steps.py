"""The steps of the workflow before its products: what each of its rules makes, and how much that is to do.

A step makes several things of one kind, as far as they belong together: each start of Python takes one or two seconds,
and what several read is read once. It is short enough that steps keep all cores of a machine, or nodes, busy.
"""

import re
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from itertools import groupby
from pathlib import Path
from typing import TypeVar

from experiments.plan.call import Job
from experiments.plan.detection import detection_files, level_of_detectors
from experiments.plan.files import ARRAY, NOTE, Files, NetworkName, Place
from experiments.plan.jobs import Jobs
from experiments.plan.reactions import cases_of_jobs, course_file, is_pushed, reaction_file, walks_in, watch_file
from experiments.plan.seeds import FIRST_TRAINING_SEED
from experiments.plan.work import SECONDS, Work, detected, estimated, fitted, steps_of, trained, walked
from mobnet.core.files import METRICS, RUN, WEIGHTS

PART_S = 3600.0  # recordings that one step makes [s]: some six minutes
PART_STEPS = 30e6  # time steps that the trainings of one step go through: some four minutes of a leg's network
Item = TypeVar("Item")


@dataclass(frozen=True)
class Step:
    """What one rule makes: how much there is to do, the files, and the job; `work.job` names log and account."""

    work: Work
    outputs: tuple[str, ...]
    make_job: Callable[[], Job]

    @property
    def rule(self) -> str:
        """Name of its rule, that of its account."""
        return re.sub(r"\W", "_", self.work.job)

    @cached_property
    def job(self) -> Job:
        """The job, whose hash of all the code behind it takes its time."""
        return self.make_job()


def all_steps(files: Files) -> Iterator[Step]:
    """Yield the steps behind everything that products are made from, those of robots last."""
    yield from _motions(files, (place for own in files.owners for place in own.recorded()))
    for own in files.owners:
        yield from _walks(own, own.recorded())
        yield from (_fit(own, method) for method in own.own_fits)
        yield from _trainings(own, own.own_networks)
        yield from _estimates(own)
        yield from _detectors(own)
        yield from _reactions(own)
    yield from (_score(files, scenario, level) for scenario, level in files.scored)


def trial_steps(files: Files) -> Iterator[Step]:
    """Yield the steps that the trials need besides: their walks, and what learns in them."""
    walked: list[Place] = []
    for walk in files.settings.development.values():
        walked += [(walk.scenario, walk.level, seed) for seed in files.development_seeds]
    yield from _motions(files, walked)
    for own in files.owners:
        yield from _walks(own, (place for place in walked if own.has(place[1])))
        fits = dict.fromkeys(own.catalogue.source_of(name) for name, *_ in own.tried_networks)
        # A run makes some of these fits already; a file must have one rule.
        yield from (_fit(own, name) for name in fits if own.fit(name) and name not in own.own_fits)
        yield from _trainings(own, own.tried_networks)
    first = files.settings.trials.random_torque.first_seed
    yield from (_falls(own, seed) for seed, own in enumerate(files.robots.values(), start=first))


def _motions(files: Files, recorded: Iterable[Place]) -> Iterator[Step]:
    """Yield the motions of the upper body, which all robots share."""
    # Other tests, such as seeds that nobody has seen, must not make the motions of trainings again: no step has both.
    seeds = defaultdict[tuple[str, bool], set[int]](set)
    for scenario, _, seed in recorded:
        if motion := files.settings.scenarios[scenario].motion:
            seeds[motion, seed < FIRST_TRAINING_SEED].add(seed)
    for (motion, _), own in sorted(seeds.items()):
        for part in _parts(sorted(own), lambda seed, name=motion: files.motion_s(name, seed), PART_S):
            account = f"motion/{motion}-s{part[0]}"
            amounts = {SECONDS: sum(files.motion_s(motion, seed) for seed in part), "motion": len(part)}
            job = partial(Jobs(files).motions, account, motion, part)
            arrays = [files.motion_place(motion, seed) for seed in part]
            yield Step(Work(account, "motion", amounts, 0.0), _both(arrays), job)


def _walks(files: Files, recorded: Iterable[Place]) -> Iterator[Step]:
    """Yield recordings and their residuals: of each scenario at a level, those for training and for tests apart."""
    # A step has one duration, and walks of tests may last otherwise than those of trainings of the same scenario.
    sets = defaultdict[tuple[str, str, bool], list[int]](list)
    # Training sets of one scenario at one level count from the same seed, and so have recordings in common.
    for scenario, level, seed in dict.fromkeys(recorded):
        sets[scenario, level, seed < FIRST_TRAINING_SEED].append(seed)
    for (scenario, level, _), seeds in sets.items():
        for part in _parts(seeds, lambda seed, name=scenario: files.duration_s([name], seed), PART_S):
            account = _account("collect", files, f"{scenario}-{level}-s{part[0]}")
            job = partial(Jobs(files).collect, account, scenario, level, part)
            arrays: list[Path] = []
            for seed in part:
                arrays += [files.array(kind, scenario, level, seed) for kind in ("recordings", "residuals")]
            yield Step(Work(account, "collect", *walked(files, scenario, part)), _both(arrays), job)


def _falls(files: Files, seed: int) -> Step:
    """Return the count of a robot's falls in the trial of random torques."""
    trial = files.settings.trials.random_torque
    account = _account("falls", files, "all")
    work = Work(account, "collect", {"surrogate s": trial.walked_s * len(trial.amplitudes_nm)}, 0.0)
    return Step(work, (str(files.falls),), partial(Jobs(files).falls, seed))


def _fit(files: Files, method: str) -> Step:
    """Return the fit of a method."""
    account = _account("fit", files, method)
    job = partial(Jobs(files).fit, method)
    return Step(Work(account, "fit", *fitted(files, method)), tuple(map(str, files.fit(method))), job)


def _trainings(files: Files, networks: Iterable[NetworkName]) -> Iterator[Step]:
    """Yield trainings: those of a step learn from one set of recordings, those on the same data one after another."""

    def learns(name: NetworkName) -> tuple[str, ...]:
        training = files.catalogue.training(name.method, name.limb)
        row = files.catalogue.method(name.method)
        learning = training.learning
        together = training.network.data, learning.labels, row.of or "", row.start or ""
        return *together, name.limb, training.target, str(learning.data_s)

    # A fine-tuning stands apart from the network that it begins with, whose weights its job reads. Within a step,
    # networks of the same limb and target follow each other, so that their data are read once.
    for _, alike in groupby(sorted(networks, key=learns), key=lambda name: learns(name)[:4]):
        for part in _parts(list(alike), lambda name: steps_of(files, name), PART_STEPS):
            folders = [files.network(*name) for name in part]
            account = _account("train", files, folders[0].name)
            job = partial(Jobs(files).train, account, part)
            outputs = tuple(f"{folder}/{name}" for folder in folders for name in (WEIGHTS, METRICS, RUN))
            yield Step(Work(account, "train", *trained(files, part)), outputs, job)


def _estimates(files: Files) -> Iterator[Step]:
    """Yield the estimates of each test at a level, by all of its methods."""
    for scenario, levels in files.catalogue.tests.items():
        for level in filter(files.has, levels):
            account = _account("estimate", files, f"{scenario}-{level}")
            job = partial(Jobs(files).estimate, account, scenario, level)
            outputs = _both(run.estimate for run in files.runs(scenario, level, levels[level]))
            yield Step(Work(account, "estimate", *estimated(files, scenario, level)), outputs, job)


def _detectors(files: Files) -> Iterator[Step]:
    """Yield the trial of the detectors of the plant of section 5.1, or of a robot, if there are some."""
    if level_of_detectors(files):
        outputs = tuple(map(str, detection_files(files).values()))
        work = Work(_account("detect", files, "all"), "detect", *detected(files))
        yield Step(work, outputs, Jobs(files).detect)


def _reactions(files: Files) -> Iterator[Step]:
    """Yield the thresholds of limbs, and the walks, of a robot that has detectors."""
    if level_of_detectors(files):
        calm = Work(_account("watch", files, "all"), "watch", {SECONDS: files.settings.reaction.calm_s}, 0.0)
        yield Step(calm, (str(watch_file(files)),), Jobs(files).watch)
        for job, cases in cases_of_jobs(files).items():
            walks = sum(walks_in(files, case) for case in cases)
            work = Work(_account("react", files, job), "react", {"walk": walks}, 0.0)
            courses = _both([course_file(files, case) for case in cases if is_pushed(files, case)])
            outputs = (*(str(reaction_file(files, case)) for case in cases), *courses)
            yield Step(work, outputs, partial(Jobs(files).react, cases))


def _score(files: Files, scenario: str, level: str) -> Step:
    """Return the scores of a test at a level."""
    seconds = files.settings.test_s(scenario) * len(files.scored_runs(scenario, level))
    work = Work(f"score/{scenario}-{level}", "score", {SECONDS: seconds}, 0.0)
    outputs = tuple(map(str, files.scores([(scenario, level)])))
    return Step(work, outputs, partial(Jobs(files).score, scenario, level))


def _account(kind: str, files: Files, name: str) -> str:
    """Return the name of a step's account; those of a robot stand in a folder of its name."""
    return "/".join(part for part in (kind, files.robot, name) if part)


def _both(arrays: Iterable[Path]) -> tuple[str, ...]:
    """Return the two files of each array."""
    return tuple(f"{stem}{ending}" for stem in arrays for ending in (ARRAY, NOTE))


def _parts(items: Sequence[Item], size: Callable[[Item], float], most: float) -> Iterator[list[Item]]:
    """Yield items in order, so many together that their sizes add up to at most `most`; a larger one stands alone."""
    part = list[Item]()
    held = 0.0
    for item in items:
        if part and held + size(item) > most:
            yield part
            part = []
            held = 0.0
        part.append(item)
        held += size(item)
    yield part

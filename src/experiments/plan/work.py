"""How much each job has to do: what a run will cost follows from it and from what jobs took before."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace
from typing import Any

from experiments.plan.dry_run import PlannedJob
from experiments.plan.files import SETS, NetworkName
from experiments.plan.parts import TOGETHER_S
from experiments.plan.plan import Plan
from experiments.plan.reactions import walks_in
from experiments.plan.stacks import Stacked, inputs_of

SECONDS = "s"
Amounts = dict[str, float]


@dataclass(frozen=True)
class Work:
    """What one job has to do.

    Attributes:
        job: name of its account, `RULE` or `RULE/...`.
        kind: jobs of one kind take as long for as much work.
        amounts: what its processor time grows with, by name: seconds of recordings [s]; steps of networks, for a
            training also times their units and their square.
        held: what its memory grows with: seconds [s] of the recordings that it holds, or numbers of training data.
    """

    job: str
    kind: str
    amounts: Mapping[str, float]
    held: float


def works_of(plan: Plan, planned: Iterable[PlannedJob]) -> list[Work]:
    """Return the work of each job that a run would start, but for rules that only name targets."""
    return [work_of(plan, job) for job in planned if job.name != job.rule or job.outputs[0]]


def work_of(plan: Plan, job: PlannedJob) -> Work:
    """Return the work of a job: of a step by its kind, of a product by all that it reads of recordings and their like.

    The first part of a job's name is its kind; products are kinds of their own.
    """
    kind = job.name.partition("/")[0]
    if kind in STEPS:
        return Work(job.name, kind, *STEPS[kind](plan, job.w))
    name = job.name.rpartition("/")[2]
    seconds = sum(read_s(plan, Path(read)) for read in plan.product(name).inputs)
    return Work(job.name, name, {SECONDS: seconds} if seconds else {}, seconds)


def read_s(plan: Plan, folder: Path) -> float:
    """Return the duration of all recordings of a set, of residuals or estimates too [s]; 0 of what is none."""
    parts = folder.parts
    if len(parts) < len(("robot", "kind", "scenario", "level")) or parts[-3] not in SETS:
        return 0.0
    robot, _, scenario, level = parts[-4:]
    return plan.jobs.files_of(robot).set_s(scenario, level)


def total(amounts: Iterable[Mapping[str, float]]) -> Amounts:
    """Return the sum of amounts, name by name."""
    sums: Amounts = {}
    for amounts_of_job in amounts:
        for name, amount in amounts_of_job.items():
            sums[name] = sums.get(name, 0.0) + amount
    return sums


def moved(plan: Plan, w: Any) -> tuple[Amounts, float]:
    """Return the work of a motion."""
    return {SECONDS: plan.files.motion_s(w.motion, int(w.seed))}, 0.0


def walked(plan: Plan, w: Any) -> tuple[Amounts, float]:
    """Return the work of recordings that are made one after another, and the longest of them [s]."""
    files = plan.jobs.files(w)
    seeds = files.seeds_of(w.scenario, w.level)
    seconds = files.duration_s([w.scenario], seeds[0], w.level)
    return {"surrogate s" if files.robot else SECONDS: seconds * len(seeds), "walk": len(seeds)}, seconds


def observed(plan: Plan, w: Any) -> tuple[Amounts, float]:
    """Return the work of the observer, and the longest recording [s]."""
    files = plan.jobs.files(w)
    seeds = files.seeds_of(w.scenario, w.level)
    return {SECONDS: files.set_s(w.scenario, w.level)}, files.duration_s([w.scenario], seeds[0], w.level)


def trained(plan: Plan, w: Any) -> tuple[Amounts, float]:
    """Return the work of a training, and the numbers of training data that it holds.

    A network that has learned in a stack has no steps of its own.
    """
    files = plan.jobs.files(w)
    rate_hz = files.settings.rates.data_hz
    training = files.catalogue.training(w.method, w.limb)
    network = training.network
    read = files.training_s(network.data)
    count = read * rate_hz * (inputs_of(files, network) + len(files.settings.layout.limbs(network.joints)))
    if "lesson" in plan.jobs.train(w):
        return {SECONDS: read}, count
    hidden = training.network.hidden or 0
    ways = {"windows": training.learning.sequences == "windows", "spectral": network.spectral}
    cell = " ".join([network.cell, *(way for way, is_so in ways.items() if is_so)])
    steps = files.learned_steps(w.method, w.limb)
    grown = {"step": steps, "step x unit": steps * hidden, "step x unit^2": steps * hidden**2}
    return {SECONDS: read, **{f"{cell} {name}": amount for name, amount in grown.items()}}, count


def stacked(plan: Plan, w: Any) -> tuple[Amounts, float]:
    """Return the work of a stack but for what the GPU does, and the numbers of the largest training data."""
    seconds, most = 0.0, 0.0
    for robot, (method, limb, seed) in plan.jobs.stacks.members[w.stack]:
        wildcards = SimpleNamespace(robot=robot, method=method, limb=limb, seed=seed)
        amounts, numbers = trained(plan, wildcards)
        seconds, most = seconds + amounts[SECONDS], max(most, numbers)
    return {SECONDS: seconds}, most


def estimated(plan: Plan, w: Any) -> tuple[Amounts, float]:
    """Return the work of all methods of a test at a level, and the seconds [s] that run side by side."""
    files = plan.jobs.files(w)
    catalogue = files.catalogue
    seconds = files.settings.test_s(w.scenario)
    whole = seconds * len(files.test_seeds)
    amounts: list[Mapping[str, float]] = [{SECONDS: whole}]
    for method in catalogue.tests[w.scenario][w.level]:
        kind = catalogue.method(method).kind
        for seed in files.run_seeds(method, w.scenario, w.level):
            networks = files.networks(method, seed, w.scenario, w.level)
            steps = seconds * files.settings.rates.data_hz * len(networks)
            amounts.append({"run": 1.0, f"{kind} s": whole, f"{kind} step": steps})
    return total(amounts), max(seconds, min(whole, TOGETHER_S))


def fitted(plan: Plan, w: Any) -> tuple[Amounts, float]:
    """Return the work of a fit, which reads the training set of one limb after the other, and the longest set [s]."""
    files = plan.jobs.files(w)
    limbs = files.catalogue.method(w.method).fitted
    read = [files.training_s(files.catalogue.network(w.method, limb).data) for limb in limbs]
    return {SECONDS: sum(read)}, max(read)


def detected(plan: Plan, w: Any) -> tuple[Amounts, float]:
    """Return the work of detectors, and the duration of all recordings of their longest test [s]."""
    files = plan.jobs.files(w)
    seconds = [files.settings.test_s(name) * len(files.test_seeds) for name in files.settings.detection_walks]
    return {SECONDS: sum(seconds)}, max(seconds)


def watched(plan: Plan, w: Any) -> tuple[Amounts, float]:
    """Return the work of the thresholds of a robot's limbs."""
    return {SECONDS: plan.jobs.files(w).settings.reaction.calm_s}, 0.0


def reacted(plan: Plan, w: Any) -> tuple[Amounts, float]:
    """Return the work of a robot's walks in a case."""
    return {"walk": walks_in(plan.jobs.files(w), w.case)}, 0.0


def scored(plan: Plan, w: Any) -> tuple[Amounts, float]:
    """Return the work of the scores of a test at a level."""
    runs = len(plan.files.scored_runs(w.scenario, w.level))
    return {SECONDS: plan.settings.test_s(w.scenario) * runs}, 0.0


def fallen(plan: Plan, w: Any) -> tuple[Amounts, float]:
    """Return the work of a robot's walks in the trial of random torques."""
    trial = plan.settings.trials.random_torque
    return {"surrogate s": trial.walked_s * len(trial.amplitudes_nm)}, 0.0


STEPS: Mapping[str, Callable[[Plan, Any], tuple[Amounts, float]]] = {  # kind -> amounts, and what is held
    "motion": moved,
    "collect": walked,
    "observe": observed,
    "fit": fitted,
    "train": trained,
    "train_stack": stacked,
    "estimate": estimated,
    "score": scored,
    "detect": detected,
    "watch": watched,
    "react": reacted,
    "falls": fallen,
}


@dataclass(frozen=True)
class OnGpu:
    """What a training does on a GPU.

    Attributes:
        networks: how many GRUs learn side by side; 0 where no rate of that was measured: of one that learns alone, or
            of other cells.
        steps: time steps from which the longest of them learns.
        all_steps: those of all of its networks.
        units: size of its state.
        batch: sequences of an update.
        horizon: time steps of an update.
    """

    networks: int
    steps: float
    all_steps: float
    units: int
    batch: int
    horizon: int


def on_gpu(plan: Plan, job: PlannedJob) -> OnGpu | None:
    """Return what a job does on a GPU, where the plan has stacks: nothing if it trains nothing there."""
    w = job.w
    alone = job.rule == "train" and "lesson" not in plan.jobs.train(w)
    if job.rule == "train_stack":
        members = plan.jobs.stacks.members[w.stack]
    elif alone:
        members = (Stacked(w.robot, NetworkName(w.method, w.limb, int(w.seed))),)
    else:
        return None
    robot, first = members[0]
    training = plan.jobs.files_of(robot).catalogue.training(first.method, first.limb)
    network = training.network
    steps: list[float] = []
    for member in members:
        steps.append(plan.jobs.files_of(member.robot).learned_steps(member.network.method, member.network.limb))
    count = 0 if alone or network.cell != "GRU" else len(members)
    batch = training.learning.batch_size
    return OnGpu(count, max(steps), sum(steps), network.hidden or 0, batch, network.horizon_steps)

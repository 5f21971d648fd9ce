"""How much each job of a plan has to do: what a run will cost follows from it and from what jobs took before."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from mobnet.core.detections import FILES
from mobnet.core.files import RUN
from mobnet.plan.plan import Plan
from mobnet.plan.runs import ARRAY, FIRST_DEVELOPMENT_SEED, Files
from mobnet.settings.networks import Network

SECONDS = "s"
FIRST_FILE = next(iter(FILES))  # of detectors: their job makes all of them
INPUTS_PER_JOINT, BASE_INPUTS = 2, 12  # of a network: position and velocity; rotation, turn and acceleration


@dataclass(frozen=True)
class Work:
    """What one job has to do.

    Attributes:
        job: name of its account, `RULE` or `RULE/...`.
        kind: jobs of one kind take as long for as much work.
        amounts: what its processor time grows with, by name: seconds of recordings [s]; steps of a network, for a
            training also times its units and their square.
        held: what its memory grows with: seconds [s] of the recordings that it holds, or numbers of training data.
    """

    job: str
    kind: str
    amounts: Mapping[str, float]
    held: float


def all_work(plan: Plan) -> tuple[Work, ...]:
    """Return the work of every job of a plan but the trials."""
    stored = {work.job: work for path in map(Path, plan.stored) for work in _behind(plan, path)}
    products = [
        Work(product.name, product.name, {SECONDS: seconds} if seconds else {}, seconds)
        for product in plan.products
        for seconds in [_seconds_of(plan, product.job.inputs)]
    ]
    return (*stored.values(), *products)


def _behind(plan: Plan, path: Path) -> Iterator[Work]:
    """Yield the work of the job that makes a stored file; none for a file that stands beside another one."""
    files, (kind, *place) = plan.files.owner_of(path)
    own = f"{files.robot}/" if files.robot else ""
    match kind, path.suffix:
        case "motions", suffix if suffix == ARRAY:
            seconds = files.motion_s(path.parent.name, int(path.stem.removeprefix("s")))
            yield Work(f"motion/{path.parent.name}-{path.stem}", "motion", {SECONDS: seconds}, seconds)
        case (("recordings" | "residuals"), suffix) if suffix == ARRAY:
            yield _recorded(files, own, {"recordings": "collect", "residuals": "observe"}[kind], path)
        case "estimates", suffix if suffix == ARRAY:
            yield _estimated(files, own, *place[:4])
        case "networks", _ if path.name == RUN:
            yield _trained(files, own, path.parent.name)
        case "fits", _:
            yield _fitted(files, own, path.stem)
        case "detection", _ if path.stem == FIRST_FILE:
            seconds = sum(files.settings.test_s(name) for name in files.settings.detection_walks)
            walked = seconds * len(files.test_seeds)
            longest = max(files.settings.test_s(name) for name in files.settings.detection_walks)
            yield Work(f"detect/{own}all", "detect", {SECONDS: walked}, longest * len(files.test_seeds))
        case "scores", _:
            runs = plan.files.runs_of(path.parent.name, path.stem)
            seconds = sum(plan.settings.test_s(run.scenario) for run in runs)
            yield Work(f"score/{path.parent.name}-{path.stem}", "score", {SECONDS: seconds}, 0.0)
        case _:
            return


def _recorded(files: Files, own: str, rule: str, path: Path) -> Work:
    """Return the work behind a recording or a residual; those of a test are made by one job, one after another."""
    scenario, level = path.parts[-3:-1]
    seconds = files.array_s(path)
    plant = "surrogate s" if own and rule == "collect" else SECONDS
    if int(path.stem.removeprefix("s")) < FIRST_DEVELOPMENT_SEED:
        whole = seconds * len(files.test_seeds)
        return Work(f"{rule}_tests/{own}{scenario}-{level}", rule, {plant: whole}, seconds)
    return Work(f"{rule}/{own}{scenario}-{level}-{path.stem}", rule, {plant: seconds}, seconds)


def _estimated(files: Files, own: str, method: str, network: str, scenario: str, level: str) -> Work:
    """Return the work of a method on a test, whose recordings run side by side through each of its networks."""
    seconds = files.settings.test_s(scenario)
    walked = seconds * len(files.test_seeds)
    networks = files.networks(method, int(network.removeprefix("n")), scenario, level)
    kind = files.settings.method(method).kind
    amounts = {f"{kind} s": walked, f"{kind} step": seconds * files.settings.rates.data_hz * len(networks)}
    return Work(f"estimate/{own}{method}-{network}-{scenario}-{level}", "estimate", amounts, walked)


def _trained(files: Files, own: str, name: str) -> Work:
    """Return the work of a training."""
    method, limb, seed = files.trained[name]
    training = files.settings.training(method, limb)
    network, hidden = training.network, training.network.hidden or 0
    read = _training_s(files, network.data)
    rate_hz = files.settings.rates.data_hz
    steps = training.epochs * (training.epoch_samples or read * rate_hz / training.learning.data_parts)
    ways = {"windows": training.learning.sequences == "windows", "spectral": network.spectral}
    cell = " ".join([network.cell, *(name for name, is_so in ways.items() if is_so)])
    amounts = {f"{cell} step": steps, f"{cell} step x unit": steps * hidden, f"{cell} step x unit^2": steps * hidden**2}
    numbers = read * rate_hz * _width(files, network)
    return Work(f"train/{own}{method}-{limb}-s{seed}", "train", {SECONDS: read, **amounts}, numbers)


def _width(files: Files, network: Network) -> int:
    """Return the number of inputs and targets of a network."""
    limbs = files.settings.layout.limbs
    seen = INPUTS_PER_JOINT * len(limbs(network.Q)) + len(limbs(network.T)) + BASE_INPUTS
    return seen + len(limbs(network.joints))


def _fitted(files: Files, own: str, method: str) -> Work:
    """Return the work of a fit, which reads the training set of one limb after the other."""
    limbs = files.settings.method(method).fitted
    read = [_training_s(files, files.settings.network(method, limb).data) for limb in limbs]
    return Work(f"fit/{own}{method}", "fit", {SECONDS: sum(read)}, max(read))


def _training_s(files: Files, name: str) -> float:
    """Return the duration of a training set [s]."""
    size = files.training_size(name)
    return size.shards * size.shard_s


def _seconds_of(plan: Plan, names: Iterable[str]) -> float:
    """Return the duration of all recordings, residuals and estimates among some files [s]."""
    arrays = [path for path in map(Path, names) if path.suffix == ARRAY]
    return sum(
        files.array_s(path) for path in arrays for files, (kind, *_) in [plan.files.owner_of(path)] if kind != "motions"
    )

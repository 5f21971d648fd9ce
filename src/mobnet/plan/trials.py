"""The trials: products that are no part of `all`. They take hours, so docs/trials holds a copy of their tables."""

from collections.abc import Iterable, Iterator
from pathlib import Path

from mobnet.core.files import WEIGHTS
from mobnet.plan.call import Call, Job
from mobnet.plan.files import Files, files_in
from mobnet.plan.jobs import KINDS
from mobnet.plan.products import TABLE, Product
from mobnet.plan.runs import Tried
from mobnet.settings.trials import Trial, of_lengths, references, tuned


def trial_products(files: Files) -> Iterator[Product]:
    """Yield the tables of what was tried: `tuning`, `lengths` and `random_torque`."""
    settings = files.settings
    given = settings.trials, settings.methods
    tables = {
        "tuning": (*references(*given), *tuned(*given)),
        "lengths": tuple(of_lengths(*given, settings.learning.rate_first)),
    }
    for name, trials in tables.items():
        yield _product(files, files.results / "trials" / name, trials)
    counted, out = tuple(own.falls for own in files.robots.values()), files.results / "trials" / "random_torque"
    arguments = {"counted": counted, "statistics": settings.evaluation.statistics, "out": out}
    job = Job(Call("mobnet.evaluation.tables.further.falls:falls", arguments), tuple(map(str, counted)))
    yield _table(out, job)


def _product(files: Files, out: Path, trials: Iterable[Trial]) -> Product:
    """Return the table of some trials, which runs all their networks on the development walks."""
    settings = files.settings
    tried = tuple(one for trial in trials for one in _tried(files, trial))
    recordings, residuals = files.development("recordings"), files.development("residuals")
    arguments = {
        "robot": settings.robot,
        "level": settings.levels[settings.development.level],
        "gravity_m_s2": settings.plant.gravity_m_s2,
        "observer": settings.observer,
        "joints": settings.layout.limb(settings.trials.limb),
        "tried": tried,
        "recordings": recordings,
        "residuals": residuals,
        "rate_hz": settings.rates.data_hz,
        "out": out,
    }
    weights = [folder / WEIGHTS for one in tried for folder in one.networks.values()]
    inputs = dict.fromkeys(map(str, files_in([recordings, residuals, list(tried), weights])))
    kinds = dict.fromkeys(f"{KINDS}.{row.kind}" for one in tried for row in one.methods.values())
    call = Call("mobnet.evaluation.tables.further.trials:trials", arguments)
    return _table(out, Job(call, tuple(inputs), tuple(kinds)))


def _table(out: Path, job: Job) -> Product:
    """Return the product of a job that writes a table."""
    return Product(out.name, job, tuple(f"{out}.{ending}" for ending in TABLE))


def _tried(files: Files, trial: Trial) -> Iterator[Tried]:
    """Yield a trial with each of its networks, or without any."""
    source = files.catalogue.source_of(trial.name)
    for seed in files.network_seeds(trial.name):
        yield Tried(
            trial.base,
            trial.name,
            dict(trial.changes),
            {name: files.catalogue.method(name) for name in dict.fromkeys([trial.name, source])},
            {limb: files.network(trial.name, limb, seed) for limb in trial.method.limbs},
            next(iter(files.fit(trial.name)), None),
            seed,
        )

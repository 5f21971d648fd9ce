"""What must hold for the sizes of every scale: batches are filled, times lie inside recordings, the run has an end."""

from collections.abc import Iterator
from itertools import chain

from experiments.settings.catalogue import Catalogue
from experiments.settings.checks.walking import is_whole
from experiments.settings.claims import TAKES
from experiments.settings.figures import Figure05, GaitFigure, HandFigure
from experiments.settings.fleet import FIRST_SEED
from experiments.settings.scales import Scale
from experiments.settings.settings import Settings
from mobnet.core.errors import misfit, not_accepted
from mobnet.formats.faults import at_most, below
from mobnet.formats.reading import Place, Problem

RESULTS_MAX = 50_000  # of one scale: its files are twice as many, and each has a place in Snakemake's plan
PASSES_MAX = 20  # of an epoch through a training set
CYCLES = 3  # a whole gait cycle follows a start within so many


def size_problems(catalogue: Catalogue) -> Iterator[Problem]:
    """Yield what does not fit at some scale, the chosen one or another."""
    settings = catalogue.settings
    names = set(chain.from_iterable(scale.experiments for scale in settings.scales.values()))
    for name, scale in settings.scales.items():
        missing = names - scale.experiments.keys()
        for experiment in sorted(missing):
            text = misfit(f"no experiment {experiment}", f"all of {', '.join(sorted(names))}, as at the other scales")
            yield ("scales", name, "experiments"), text
        if missing:
            return
    for name, scale in settings.scales.items():
        scaled = catalogue.at_scale(name)
        for part, rows in (("experiments", scale.experiments), ("robots", scale.robots)):
            for experiment, row in rows.items():
                place = ("scales", name, part, experiment)
                if experiment not in names:
                    yield place, not_accepted("experiment", experiment, sorted(names))
                yield from below((*place, "seeds"), max(row.seeds or [0]), FIRST_SEED, "the seeds of robots")
        yield from _sweep_problems(scaled.settings)
        yield from _length_problems(scaled.settings, scale)
        yield from _time_problems(scaled, scale)
        yield from _training_problems(scaled)
        results = _result_count(scaled)
        if results > RESULTS_MAX:
            accepted = f"{RESULTS_MAX} of them, by fewer shards or seeds"
            yield ("scales", name), misfit(f"{results} recordings, residuals, networks and estimates", accepted)


def _sweep_problems(settings: Settings) -> Iterator[Problem]:
    """Yield values of a sweep that it does not have, or too few for a claim."""
    place = ("scales", settings.scale, "sweeps")
    for key, values in settings.sizes.sweeps.items():
        row = settings.sweeps[key]
        for value in values:
            if value not in row.values:
                yield (*place, key), not_accepted(f"value of sweep {key}", value, row.values)
    for name, claim in settings.with_own_sweeps().claims.items():
        least, step = TAKES[claim.quantity]
        more = len(claim.cells) - least
        if more < 0 or (more % step if step else more):
            yield place, misfit(f"{len(claim.cells)} values for claim {name}", f"at least {least}")


def _result_count(catalogue: Catalogue) -> int:
    """Return how many recordings, residuals, networks and estimates the chosen scale has."""
    settings = catalogue.settings
    tests = catalogue.tests.values()
    shards = settings.sizes.test.shards
    recorded = sum(row.sizes[settings.scale].shards for row in settings.training_sets.values())
    recorded += shards * sum(map(len, tests))
    seeds = dict[str, list[int]]()
    for name, method in catalogue.all_methods.items():
        seeds[name] = [len(catalogue.experiment(name, limb).seeds) for limb in method.limbs]
    runs = list[int]()
    for methods in chain.from_iterable(levels.values() for levels in tests):
        runs += [max(seeds[catalogue.network_source_of(name)], default=1) for name in methods]
    return 2 * recorded + sum(map(sum, seeds.values())) + shards * sum(runs)


def _length_problems(settings: Settings, scale: Scale) -> Iterator[Problem]:
    """Yield durations of recordings that are no whole number of samples."""
    rate = settings.rates.data_hz
    name = settings.scale
    sizes: dict[Place, float] = {("scales", name, "test", "shard_s"): scale.test.shard_s}
    for test, duration in scale.durations_s.items():
        sizes["scales", name, "durations_s", test] = duration
    for key, row in settings.training_sets.items():
        sizes["training_sets", key, "sizes", name, "shard_s"] = row.sizes[name].shard_s
    for place, value in sizes.items():
        if not is_whole(value * rate):
            yield place, misfit(value, f"a whole number of samples at {rate} Hz")


def _time_problems(catalogue: Catalogue, scale: Scale) -> Iterator[Problem]:
    """Yield figures and pushes behind the end of a test; a scale with `figure_start_s` is too short for pushes."""
    settings = catalogue.settings
    length = scale.test.shard_s
    cycle = CYCLES * 2 * max(settings.commands.duration_s)
    if scale.figure_start_s is not None:
        place = ("scales", settings.scale, "figure_start_s")
        what = f"{CYCLES} gait cycles before the end of a test"
        yield from at_most(place, scale.figure_start_s, length - cycle, what)
        return
    ends = list[tuple[Place, str, float, float]]()  # place, test, value and time after it that the test must last
    for name, section in settings.evaluation:
        if isinstance(section, Figure05 | GaitFigure):
            ends.append((("evaluation", name, "start_s"), section.scenario, section.start_s, cycle))
        elif isinstance(section, HandFigure):
            ends.append((("evaluation", name, "end_s"), section.scenario, section.end_s, 0.0))
    for test in catalogue.tests:
        for push in settings.scenarios[test].pushes:
            row = settings.pushes[push]
            for index, start in enumerate(row.at_s or ()):
                ends.append((("pushes", push, "at_s", index), test, start, row.duration_s[1]))
    for place, test, value, after in ends:
        most = min(settings.test_s(test), settings.recording.episode_s) - after
        lasts = f"for {test} lasts {settings.test_s(test)} s at scale {settings.scale}"
        yield from at_most(place, value, most, lasts)


def _training_problems(catalogue: Catalogue) -> Iterator[Problem]:
    """Yield trainings whose data do not fill a batch, a stream or a validation, or are gone through without end."""
    for name, method in catalogue.all_methods.items():
        for limb in method.limbs:
            yield from _filling_problems(catalogue, name, limb)


def _filling_problems(catalogue: Catalogue, name: str, limb: str) -> Iterator[Problem]:
    """Yield what does not fit in the training of a method's network."""
    settings = catalogue.settings
    training = catalogue.training(name, limb)
    rate = settings.rates.data_hz
    network = training.network
    learning = training.learning
    scale = settings.scale
    size = settings.training_sets[network.data].sizes[scale]
    horizon = network.horizon_steps
    contiguous = min(size.shard_s, settings.recording.episode_s) * rate
    key: Place = ("learning",) if settings.sizes.stream_s is None else ("scales", scale)
    where = f"of {name}-{limb} at scale {scale}"
    if not horizon / rate <= learning.stream_s <= size.shard_s:
        accepted = f"{horizon / rate:g} (horizon_steps) to {size.shard_s:g} (shard_s) {where}"
        yield (*key, "stream_s"), misfit(learning.stream_s, accepted)
    if not size.held_out and contiguous * learning.validation_share < horizon:
        accepted = f"at least {horizon / contiguous:.3g}, a horizon {where}"
        yield ("learning", "validation_share"), misfit(learning.validation_share, accepted)
    share = 1 - size.held_out / size.shards if size.held_out else 1 - learning.validation_share
    rows_kept = size.shards * size.shard_s * rate * share / learning.data_parts
    key = ("learning",) if settings.sizes.batch_size is None else ("scales", scale)
    if learning.batch_size * horizon > rows_kept:
        accepted = f"at most {rows_kept // horizon:.0f}, the horizons in the data {where}"
        yield (*key, "batch_size"), misfit(learning.batch_size, accepted)
    most = PASSES_MAX * size.shards * size.shard_s * rate
    wanted = training.epoch_samples
    if wanted is not None and not learning.batch_size * horizon <= wanted <= most:
        place = "scales", scale, "experiments", network.experiment, "epoch_samples"
        yield place, misfit(wanted, f"{learning.batch_size * horizon} (a batch) to {most:.0f} {where}")

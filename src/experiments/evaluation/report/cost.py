"""What a run of the workflow will cost, priced by the rates of the published one: `./reproduce cost`.

Without targets it prices a run from nothing; with some, what a run of them would start now: `./reproduce cost all`
after an edit, or `./reproduce cost tables/table_06.tex`. A run without a GPU is priced with one, too, on which networks
of one shape learn side by side.
"""

import json
import logging
import sys
from argparse import Namespace
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

import yaml

from experiments.evaluation.report.compute import HOUR_S, STAGES, WHOLE, stage_of
from experiments.evaluation.report.paper import missing_packages
from experiments.evaluation.tables.layout import markdown_table
from experiments.plan.dry_run import PlannedJob, dry_run
from experiments.plan.gpu import GPU_RATES, GpuNote, GpuRates
from experiments.plan.gpu import fitted as fitted_rates
from experiments.plan.plan import Plan, make_plan
from experiments.plan.prices import RATES, Kind, Priced, RatesNote, kind_of, price, priced
from experiments.plan.room import RESOURCE, share_at_once
from experiments.plan.schedule import TimedJob, elapsed_s
from experiments.plan.work import Work, works_of
from experiments.running.words import cost_parser, scale_of_targets
from experiments.settings.load import load_settings
from mobnet.core.errors import ConfigError, DataError
from mobnet.core.notes import read_note
from mobnet.core.printed import printed

log = logging.getLogger(__name__)

HEADER = ("stage", "jobs", "core-hours", "memory [MiB]")
GPU_HEADER = ("trainings on the GPU", "jobs", "time steps [1e9]", "GPU-hours")
SIDE_BY_SIDE, ALONE = "networks side by side", "one network after another, or of other cells"
CORES, CORES_WITH_GPU = 2, 16  # of machines
MB_OF_GB = 1e3
STEPS_UNIT = 1e9
PERCENT = 100.0
Cost = tuple[int, float, float]  # jobs, processor time [s], largest peak of the memory [MiB]
STACK, TRAINING = "train_stack", "train"  # rules


def costs(works: Iterable[Work], kinds: Mapping[str, Kind]) -> dict[str, Cost]:
    """Return what the jobs of each stage will take, then all of them; jobs without a rate do not count."""
    found: dict[str, Cost] = dict.fromkeys((*STAGES, WHOLE), (0, 0.0, 0.0))
    for work in works:
        if (kind := kind_of(work, kinds)) is not None:
            cpu_s, peak_mib = price(work, kind)
            for stage in (stage_of(work.job), WHOLE):
                jobs, before_s, most_mib = found[stage]
                found[stage] = jobs + 1, before_s + cpu_s, max(most_mib, peak_mib)
    return {stage: cost for stage, cost in found.items() if cost[0]}


def expected_s(plan: Plan, jobs: Mapping[int, PlannedJob]) -> dict[int, float]:
    """Return what jobs, by their numbers, will take [s]; nothing where the rates cannot be read."""
    try:
        rates = read_note(RATES, RatesNote)
        gpu = fitted_rates(read_note(GPU_RATES, GpuNote))
    except DataError:
        return {}
    numbers = {id(job): number for number, job in jobs.items()}
    found: dict[int, float] = {}
    for job in priced(plan, rates, gpu if plan.settings.stacks.side_by_side else None, jobs.values()):
        found[numbers[id(job.planned)]] = job.cpu_s + job.gpu_s
    return found


def time_s(jobs: Iterable[Priced], cores: int, gpus: int = 0) -> float:
    """Return how long a machine takes for jobs that wait for each other [s]."""
    return elapsed_s([TimedJob(job.planned, job.cpu_s + job.gpu_s, job.gpu_s > 0.0) for job in jobs], cores, gpus)


def gpu_rows(jobs: Iterable[Priced]) -> list[list[str]]:
    """Return the rows of a table of what a GPU does."""
    rows: list[list[str]] = []
    there = [(job.on_gpu, job.gpu_s) for job in jobs if job.on_gpu and job.gpu_s]
    for name in (SIDE_BY_SIDE, ALONE):
        own = [(work, seconds) for work, seconds in there if bool(work.networks) == (name == SIDE_BY_SIDE)]
        steps = sum(work.all_steps for work, _ in own)
        hours = sum(seconds for _, seconds in own) / HOUR_S
        rows.append([name, str(len(own)), f"{steps / STEPS_UNIT:.2f}", f"{hours:.2f}"])
    return rows


def report(plan: Plan, rates: RatesNote, gpu: GpuRates | None, planned: Sequence[PlannedJob]) -> str:
    """Return the price of some jobs of a plan as text: a row for each stage, the disk, time, and what has no rate.

    With a GPU its rows follow, and only the rest of the trainings counts as core-hours.
    """
    jobs = priced(plan, rates, gpu, planned)
    works = [job.work for job in jobs]
    found = costs(works, rates.kinds)
    rows = [[stage, str(n), f"{cpu_s / HOUR_S:.2f}", f"{mib:.0f}"] for stage, (n, cpu_s, mib) in found.items()]
    unknown = sorted({work.kind for work in works if kind_of(work, rates.kinds) is None})
    disk_gb = sum(float(job.resources.get(RESOURCE, 0)) for job in planned) / MB_OF_GB
    disk = f"{disk_gb:.1f} GB"
    if plan.settings.keep != "all":
        # What is let go in time is never there together with all else.
        share = share_at_once([TimedJob(job.planned, job.cpu_s) for job in jobs], CORES)
        disk = f"{share * disk_gb:.1f} GB at once, of {disk_gb:.1f} GB that are written"
    if works and not rows:
        return f"{len(works)} jobs would run, which the published run did not have, so that nothing prices them: " + (
            ", ".join(unknown)
        )
    lines = [markdown_table(HEADER, rows) if works else "nothing would run: all is up to date"]
    if gpu:
        made = f"{gpu.note.made_by} on an {gpu.note.device} ({gpu.note.date}, torch {gpu.note.torch})"
        lines += [markdown_table(GPU_HEADER, gpu_rows(jobs)), f"GPU-hours: rates of {made}, not of this code"]
        times = f"{time_s(jobs, CORES_WITH_GPU, 1) / HOUR_S:.2f} h on {CORES_WITH_GPU} cores and one GPU"
    else:
        hours = [f"{time_s(jobs, cores) / HOUR_S:.2f} h on {cores} cores" for cores in (CORES, CORES_WITH_GPU)]
        times = ", ".join(hours)
    lines.append(f"disk: {disk}; time: {times}")
    lines += [f"without a rate, and not counted: {', '.join(unknown)}"] if unknown else []
    return "\n".join(lines)


def published(rates: RatesNote, with_pdf: bool) -> list[Work]:
    """Return what the jobs of the scale of the published run have to do, as its sizes are now."""
    plan = make_plan(load_settings(overrides={"scale": rates.scale}), with_pdf=with_pdf)
    _, alone = with_stacks({"stacks": {"side_by_side": False}})  # as that run was
    return works_of(plan, dry_run(["all"], [f"scale={rates.scale}", alone], from_nothing=True))


def check(rates: RatesNote, works: Sequence[Work]) -> str:
    """Return how the rates price the jobs of the scale of the run to which they are fitted."""
    _, cpu_s, peak_mib = costs(works, rates.kinds)[WHOLE]
    gone = sorted({*rates.kinds} - {work.kind for work in works})
    pairs = {"core-hours": (cpu_s / HOUR_S, rates.core_h, 2), "MiB": (peak_mib, rates.peak_mib, 0)}
    told = [
        f"{priced:.{digits}f} {unit} where it took {took:.{digits}f} ({PERCENT * (priced / took - 1):+.0f} %)"
        for unit, (priced, took, digits) in pairs.items()
    ]
    lines = [f"scale {rates.scale} now, beside the published run, to which the rates are fitted: {', '.join(told)}"]
    lines += [f"its jobs were cut in another way, so that prices are rough: {', '.join(gone)}"] if gone else []
    return "\n".join(lines)


def overrides(words: Sequence[str]) -> dict[str, Any]:
    """Return the values that replace those of the configuration, from words KEY=VALUE.

    Raises:
        ConfigError: a word is none.
    """
    parts = [word.partition("=") for word in words]
    for word, (key, sign, _) in zip(words, parts, strict=True):
        if not (key and sign):
            raise ConfigError(f"--config: {word!r} is not accepted; accepted: KEY=VALUE, a key of configs")
    try:
        return {key: yaml.safe_load(value) for key, _, value in parts}
    except (yaml.YAMLError, RecursionError) as error:
        raise ConfigError(f"--config: {' '.join(str(error).split())}; accepted: a value in plain YAML") from None


def run(options: Namespace) -> Iterator[str]:
    """Yield what a run will cost, as the command's options say: without a GPU, and with one where networks learn."""
    with_pdf = not missing_packages()
    rates = read_note(RATES, RatesNote)
    given = overrides(options.config)
    if scale := scale_of_targets(options.targets, given.get("scale")):
        given["scale"] = scale  # as a run of these targets takes it
    targets = options.targets or ["all"]
    nothing = not options.targets
    planned = dry_run(targets, options.config, from_nothing=nothing)
    has_gpu = any(job.rule == STACK for job in planned)
    plan = make_plan(load_settings(overrides=given), with_pdf=with_pdf)
    parts: list[str] = [f"scale {plan.settings.scale}, priced as on this processor: {rates.processor}"]
    if not has_gpu:
        parts.append(report(plan, rates, None, planned))
    if any(job.rule in TRAINING for job in planned):
        gpu = fitted_rates(read_note(GPU_RATES, GpuNote))
        beside, word = with_stacks(given)
        stacked = make_plan(load_settings(overrides=beside), with_pdf=with_pdf)
        jobs = planned if has_gpu else dry_run(targets, [*options.config, word], from_nothing=nothing)
        how = ", on which networks of one shape learn side by side" if any(job.rule == STACK for job in jobs) else ""
        parts.append(f"with a GPU{how}:\n\n{report(stacked, rates, gpu, jobs)}")
    # A dry run takes seconds: the one that is priced often is that of the published run.
    is_published = nothing and given.keys() <= {"scale"} and plan.settings.scale == rates.scale and not has_gpu
    parts.append(check(rates, works_of(plan, planned) if is_published else published(rates, with_pdf)))
    yield "\n\n".join(parts)


def with_stacks(given: Mapping[str, Any]) -> tuple[dict[str, Any], str]:
    """Return values of the configuration, and a word of a call, by which networks learn side by side.

    A yes or no that is given stays.
    """
    own = given.get("stacks")
    stacks = {"side_by_side": True, **(own if isinstance(own, dict) else {})}
    return {**given, "stacks": stacks}, f"stacks={json.dumps(stacks)}"


def main(words: Sequence[str]) -> int:
    """Print what a run will cost; return the exit status."""
    options = cost_parser().parse_args(words)
    return printed(log, lambda: run(options))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

"""What a run of the workflow will cost, priced by the rates of the published one: `./reproduce cost`.

Without targets it prices a run from nothing; with some, what a run of them would start now: `./reproduce cost all`
after an edit, or `./reproduce cost tables/table_06.tex`.
"""

import logging
import sys
from argparse import Namespace
from collections.abc import Iterable, Iterator, Sequence
from typing import Any

import yaml

from experiments.evaluation.report.compute import HOUR_S, STAGES, WHOLE, stage_of
from experiments.evaluation.report.paper import missing_packages
from experiments.evaluation.report.rates import RATES, Kind, RatesNote, price
from experiments.evaluation.tables.layout import markdown_table
from experiments.plan.dry_run import PlannedJob, dry_run
from experiments.plan.plan import Plan, make_plan
from experiments.plan.room import RESOURCE
from experiments.plan.work import Work, works_of
from experiments.running.words import cost_parser, scale_of_targets
from experiments.settings.load import load_settings
from mobnet.core.errors import ConfigError
from mobnet.core.notes import read_note
from mobnet.core.printed import printed

log = logging.getLogger(__name__)

HEADER = ("stage", "jobs", "core-hours", "memory [MiB]")
MB_OF_GB = 1e3
PERCENT = 100.0
Cost = tuple[int, float, float]  # jobs, processor time [s], largest peak of the memory [MiB]


def costs(works: Iterable[Work], kinds: dict[str, Kind]) -> dict[str, Cost]:
    """Return what the jobs of each stage will take, then all of them; jobs without a rate do not count."""
    found: dict[str, Cost] = dict.fromkeys((*STAGES, WHOLE), (0, 0.0, 0.0))
    for work in works:
        if work.kind in kinds:
            cpu_s, peak_mib = price(work, kinds[work.kind])
            for stage in (stage_of(work.job), WHOLE):
                jobs, before_s, most_mib = found[stage]
                found[stage] = jobs + 1, before_s + cpu_s, max(most_mib, peak_mib)
    return {stage: cost for stage, cost in found.items() if cost[0]}


def report(plan: Plan, rates: RatesNote, planned: Sequence[PlannedJob]) -> str:
    """Return the price of some jobs of a plan as text: a row for each stage, the disk, and what has no rate."""
    works = works_of(plan, planned)
    found = costs(works, rates.kinds)
    rows = [[stage, str(n), f"{cpu_s / HOUR_S:.2f}", f"{mib:.0f}"] for stage, (n, cpu_s, mib) in found.items()]
    unknown = sorted({work.kind for work in works} - {*rates.kinds})
    disk_gb = sum(float(job.resources.get(RESOURCE, 0)) for job in planned) / MB_OF_GB
    lines = [
        f"scale {plan.settings.scale}, priced as on this processor: {rates.processor}",
        "",
        markdown_table(HEADER, rows) if works else "nothing would run: all is up to date",
        f"disk: {disk_gb:.1f} GB; time: the core-hours over the number of cores",
        "GPU-hours: none, as no training on a GPU has been measured",
    ]
    lines += [f"without a rate, and not counted: {', '.join(unknown)}"] if unknown else []
    return "\n".join(lines)


def published(rates: RatesNote, with_pdf: bool) -> list[Work]:
    """Return what the jobs of the scale of the published run have to do, as its sizes are now."""
    plan = make_plan(load_settings(overrides={"scale": rates.scale}), with_pdf=with_pdf)
    return works_of(plan, dry_run(["all"], [f"scale={rates.scale}"], from_nothing=True))


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
    """Yield what a run will cost, as the command's options say."""
    with_pdf = not missing_packages()
    rates = read_note(RATES, RatesNote)
    given = overrides(options.config)
    if scale := scale_of_targets(options.targets, given.get("scale")):
        given["scale"] = scale  # as a run of these targets takes it
    plan = make_plan(load_settings(overrides=given), with_pdf=with_pdf)
    targets = options.targets or ["all"]
    planned = dry_run(targets, options.config, from_nothing=not options.targets)
    # A dry run takes seconds: the one that is priced often is that of the published run.
    is_published = not options.targets and given.keys() <= {"scale"} and plan.settings.scale == rates.scale
    works = works_of(plan, planned) if is_published else published(rates, with_pdf)
    yield f"{report(plan, rates, planned)}\n{check(rates, works)}"


def main(words: Sequence[str]) -> int:
    """Print what a run will cost; return the exit status."""
    options = cost_parser().parse_args(words)
    return printed(log, lambda: run(options))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

"""Errors and other measures of estimates, a row for each joint, run and metric."""

import importlib
import logging
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import astuple, replace
from itertools import groupby
from math import isnan
from pathlib import Path
from types import ModuleType

import numpy as np
from pydantic import ValidationError

from experiments.evaluation.compare.pair import Measures, Pair, read_pair
from experiments.evaluation.compare.scene import Scene
from experiments.evaluation.measure.estimates import run_errors
from experiments.evaluation.number.rows import write_csv
from experiments.plan.runs import Run
from experiments.records.scores import SCORES, Score
from experiments.settings.measures import Measure, Scoring
from experiments.settings.metrics import SECTIONS, unit_of_metric
from experiments.settings.settings import Settings
from experiments.settings.verdicts import MOB_NET, SHUFFLED
from mobnet.core.errors import not_accepted
from mobnet.core.joints import JointLayout
from mobnet.formats.base import Section
from mobnet.formats.faults import problems
from mobnet.formats.reading import Place

ESTIMATES = "experiments.evaluation.measure.estimates"
log = logging.getLogger(__name__)
AVERAGE = "avg"


def module_of(name: str) -> ModuleType:
    """Return the module that measures what a section asks for."""
    return importlib.import_module(f"{ESTIMATES}.{name}")


def numbers_of(name: str, section: Section) -> Section:
    """Return a section as its module takes it: of an entry of `measures`, the module's section `Options`."""
    return module_of(name).Options.model_validate(section.options) if isinstance(section, Measure) else section


def measure_problems(settings: Settings) -> Iterator[tuple[Place, str]]:
    """Yield the place and the text of every entry of `measures` that names no module, or numbers that it refuses."""
    for name, measure in settings.evaluation.measures.items():
        place: Place = ("evaluation", "measures", name)
        if name not in SECTIONS:
            yield place, not_accepted("module of measures", name, SECTIONS)
            continue
        try:
            numbers_of(name, measure)
        except ValidationError as error:
            faults = problems(error, module_of(name).Options, measure.options)
            yield from (((*place, "options", *inner), text) for inner, text in faults)


def score(layout: JointLayout, runs: Sequence[Run], asked: Scoring, out: Path) -> None:
    """Score every run of a test and write one CSV, a row of `Score` for each joint, run and metric.

    The error is `tau_ext` of the estimate minus `tau_ext_lp` of the residual file, the truth behind the observer's
    low-pass (15): what a residual can follow at best (section 5.1, on Figure 6). `rmse_raw` is that to `tau_ext` of the
    recording. `asked` says what else is measured, and on which runs. Rows come recording by recording.
    """
    rows: list[Score] = []
    count = len({run.recording for run in runs})
    # Recording by recording, so that the columns of each are read once and not by every method again.
    by_recording = groupby(sorted(runs, key=lambda run: str(run.recording)), lambda run: run.recording)
    for number, (recording, runs_on_it) in enumerate(by_recording, start=1):
        scene = Scene(recording, layout, asked)
        for run in runs_on_it:
            rows += score_run(run, scene)
        log.info("%d of %d recordings scored", number, count)
    write_csv(out, SCORES, [astuple(row) for row in rows])
    log.info("%d runs, %d rows", len(runs), len(rows))


def score_run(run: Run, scene: Scene) -> list[Score]:
    """Return the rows of one run: each joint, then the average of each limb, for each metric.

    A metric has no row of a joint for which it is not defined, and none of a push that the run is too short for. A limb
    whose network has run under an earlier seed has no row: it counts once. Of MOB-Net follow the errors of the same
    estimate half a walk late, as `SHUFFLED`: right in size and wrong in time, it is a control of verdicts.
    """
    pair = read_pair(run, scene.layout)
    rows = score_rows(run, run.method, measured(pair, scene), scene.layout)
    if run.method == MOB_NET:
        rows += score_rows(run, SHUFFLED, [late_errors(pair, scene)], scene.layout)
    return rows


def late_errors(pair: Pair, scene: Scene) -> tuple[Pair, Measures]:
    """Return a run with its estimate half a walk late, and its errors; what is no error knows nothing of time."""
    late = replace(pair, estimate=np.roll(pair.estimate, len(pair.estimate) // 2, axis=0))
    errors = (error for error in run_errors.measure(late, scene) if error.metric.startswith(run_errors.ERROR))
    return late, errors


def score_rows(
    run: Run, method: str, measured_parts: Iterable[tuple[Pair, Measures]], layout: JointLayout
) -> list[Score]:
    """Return the rows of what was measured of a run, under the name of a method."""
    names = run.scenario, run.level, method, run.network_seed, run.test_seed
    rows: list[Score] = []
    for part, measures in measured_parts:
        for metric, numbers, average_only in measures:
            values = dict(zip(part.joints, numbers.tolist(), strict=True))
            defined = {joint: value for joint, value in values.items() if not isnan(value)}
            for limb, joint, value, unit in limb_values(layout, defined):
                # A network that stands in for several seeds is one network: with a row for each seed it would have no
                # variance over networks and yet count as several (docs/notes/measures.md).
                if limb in run.repeated or (average_only and joint != AVERAGE):
                    continue
                rows.append(Score(*names, limb, joint, metric, value, unit_of_metric(metric, unit)))
    return rows


def measured(pair: Pair, scene: Scene) -> Iterator[tuple[Pair, Measures]]:
    """Yield the errors of a run, then what sections ask for of it, each with the joints that it has."""
    yield pair, run_errors.measure(pair, scene)
    for name, section in scene.asked.sections.items():
        if part := shown(pair, scene.layout, section):
            yield part, module_of(name).measure(part, scene, numbers_of(name, section))


def shown(pair: Pair, layout: JointLayout, section: Section) -> Pair | None:
    """Return the joints of a run that a section shows, those of its limbs or of its test's; None if it shows none."""
    run = pair.run
    tests = getattr(section, "tests", (section,))
    for test in tests.values() if isinstance(tests, dict) else tests:
        if (test.scenario, test.level) == (run.scenario, run.level) and run.method in test.methods:
            return pair.only(layout.limbs(getattr(test, "limbs", None) or [section.limb]))
    return None


def limb_values(layout: JointLayout, values: Mapping[str, float]) -> list[tuple[str, str, float, str]]:
    """Return (limb, joint or `avg`, value, unit) of the joints' numbers given [N m], V1..V3 [N], limb by limb.

    The virtual joints have two averages, of N and of N m, as in Table 6.
    """
    rows: list[tuple[str, str, float, str]] = []
    for limb, members in layout.groups.items():
        present = [joint for joint in members if joint in values]
        rows += [(limb, joint, values[joint], layout.unit(joint)) for joint in present]
        for unit, same in groupby(present, key=layout.unit):
            rows.append((limb, AVERAGE, float(np.mean([values[joint] for joint in same])), unit))
    return rows

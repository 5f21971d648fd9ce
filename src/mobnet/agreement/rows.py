"""Rows of scores, and fits without networks, against their places and the configuration."""

import math
import re
from collections.abc import Iterable, Iterator
from itertools import groupby
from pathlib import Path
from typing import Any

from mobnet.agreement.said import differences
from mobnet.core.columns import Score
from mobnet.core.errors import not_accepted
from mobnet.core.metrics import METRIC, kind_of_metric, unit_of_metric
from mobnet.core.notes import read_note
from mobnet.estimation.kinds.friction import FrictionNote, JointNote, Options, fitted_joints
from mobnet.evaluation.measure.scores import AVERAGE, ERROR
from mobnet.evaluation.number.rows import read_scores
from mobnet.plan.runs import Files, Run
from mobnet.settings.checks.results import Results

PRINTED = 1e-4  # relative error of numbers with six digits, and of their mean
RUN_FIELDS = ("level", "method", "network_seed", "test_seed")  # of a score
RISING = "static"  # term that is zero for all joints of a robot whose friction does not fall with the speed


def fit_faults(path: Path, place: tuple[str, ...], files: Files) -> Iterator[str]:
    """Yield in what a fit is not the one that the row of its method asks for."""
    settings, catalogue, method = files.settings, files.catalogue, path.stem
    if method not in catalogue.all_methods or not catalogue.method(method).fitted:
        return
    note, options = read_note(path, FrictionNote), Options.model_validate(catalogue.method(method).options)
    yield from differences(vars(note), {"smoothing_rad_s": options.smoothing_rad_s})
    limbs = [catalogue.network(method, limb) for limb in catalogue.method(method).fitted]
    wanted = fitted_joints(settings.layout, options, limbs)
    for term in options.terms:
        held = [note.joints[joint].terms()[term] for joint in wanted if joint in note.joints and term in wanted[joint]]
        if held and not any(held) and term != RISING:
            yield not_accepted(f"joints: {term}", 0.0, [f"above 0 for some joint, as `methods.{method}` fits it"])
    for joint, terms in wanted.items():
        if joint not in note.joints:
            yield f"joints: {joint!r} is missing; accepted: every joint of `methods.{method}.fitted`"
            continue
        for term, value in note.joints[joint].terms().items():
            if value and term not in terms:
                yield not_accepted(f"joints.{joint}: {term}", value, [f"0, as `methods.{method}` fits {terms}"])
        yield from _fitted_faults(joint, note.joints[joint], options)


def _fitted_faults(joint: str, row: JointNote, options: Options) -> Iterator[str]:
    """Yield numbers of a joint that no regression with these options gives."""
    if "static" in options.terms and row.stribeck_rad_s not in options.stribeck_rad_s:
        yield not_accepted(f"joints.{joint}: stribeck_rad_s", row.stribeck_rad_s, map(str, options.stribeck_rad_s))
    if row.left_rms_nm > row.target_rms_nm * (1.0 + PRINTED):
        yield not_accepted(
            f"joints.{joint}: left_rms_nm", row.left_rms_nm, [f"at most target_rms_nm, {row.target_rms_nm}"]
        )


def score_faults(path: Path, place: tuple[str, ...], files: Files) -> Iterator[str]:
    """Yield in what the rows of scores are not those of a test's runs at a level."""
    scenario, level = path.parent.name, path.stem
    if level not in files.catalogue.tests.get(scenario, {}):
        return
    rows = read_scores(path)
    runs = {(run.level, run.method, run.network_seed, run.test_seed): run for run in files.runs_of(scenario, level)}
    known = {name: sorted({str(key[k]) for key in runs}) for k, name in enumerate(RUN_FIELDS)}
    known["scenario"] = [scenario]
    for line, row in enumerate(rows, start=2):
        for name, accepted in known.items():
            if str(getattr(row, name)) not in accepted:
                yield not_accepted(f"line {line}: {name}", getattr(row, name), accepted)
        yield from (f"line {line}: {fault}" for fault in _row_faults(row, files))
    results = Results(files.catalogue)
    for metric in sorted({row.metric for row in rows if re.fullmatch(METRIC, row.metric)}):
        if text := results.not_scored(scenario, metric):
            yield f"metric {metric}: {text}"
    limbs: dict[tuple[Any, ...], set[str]] = {key: set() for key in runs}
    for row in rows:
        limbs.setdefault(run_of(row), set()).update([row.limb] if row.metric == ERROR else ())
    for key, run in runs.items():
        for limb in sorted(_limbs_of(run, results) - limbs[key]):
            told = {**dict(zip(RUN_FIELDS, key, strict=True)), "limb": limb, "metric": ERROR}
            yield f"rows: {told} is missing; accepted: every limb that a run estimates"
    yield from _average_faults(rows, files)


def run_of(row: Score) -> tuple[Any, ...]:
    """Return what names the run of a score: level, method, seed of the networks, seed of the test."""
    return tuple(getattr(row, name) for name in RUN_FIELDS)


def _limbs_of(run: Run, results: Results) -> set[str]:
    """Return the limbs that have errors in a run, because the run estimates a joint of theirs."""
    joints = set(results.catalogue.estimated(run.method, run.scenario, run.level))
    found = {limb for limb, members in results.layout.groups.items() if joints.intersection(members)}
    return found.difference(run.repeated)


def _row_faults(row: Score, files: Files) -> Iterator[str]:
    """Yield what is wrong with the names and the unit of a score."""
    layout = files.settings.layout
    if not re.fullmatch(METRIC, row.metric):
        yield not_accepted("metric", row.metric, ["a name of `mobnet.core.metrics`"])
        return
    joints = layout.groups.get(row.limb)
    if joints is None:
        yield not_accepted("limb", row.limb, layout.groups)
    elif row.joint not in (*joints, AVERAGE):
        yield not_accepted("joint", row.joint, [*joints, AVERAGE])
    else:
        units = {unit_of_metric(row.metric, layout.unit(joint)) for joint in joints if row.joint in (joint, AVERAGE)}
        if row.unit not in units:
            yield not_accepted("unit", row.unit, units)
    low, high = kind_of_metric(row.metric).ends or (-math.inf, math.inf)
    if not low <= row.value <= high:
        yield not_accepted(f"value of {row.metric}", row.value, [f"{low:g} to {high:g}"])


def _average_faults(rows: Iterable[Score], files: Files) -> Iterator[str]:
    """Yield means that are not those of their joints, and joints without an error."""

    def whose(row: Score) -> tuple[object, ...]:
        return row.level, row.method, row.network_seed, row.test_seed, row.limb, row.metric, row.unit

    layout = files.settings.layout
    for key, members in groupby(sorted(rows, key=whose), whose):
        values = {row.joint: row.value for row in members}
        *run, limb, metric, unit = key
        expected = [j for j in layout.groups.get(str(limb), ()) if layout.unit(j) == unit]
        joints = [joint for joint in values if joint != AVERAGE]
        where = f"rows of {', '.join(map(str, run))}, limb {limb}, metric {metric}"
        if metric == ERROR:
            missing = [joint for joint in expected if joint not in joints]
            yield from (f"{where}: {joint!r} is missing; accepted: {', '.join(expected)}" for joint in missing)
        mean = sum(values[joint] for joint in joints) / max(len(joints), 1)
        if AVERAGE not in values:
            yield f"{where}: {AVERAGE!r} is missing; accepted: {mean:.6g}, the mean of its joints"
        average = values.get(AVERAGE, mean)
        if joints and unit in ("N", "N m") and not math.isclose(average, mean, rel_tol=PRINTED, abs_tol=PRINTED**2):
            yield not_accepted(f"{where}: {AVERAGE}", average, [f"{mean:.6g}, the mean of its joints"])

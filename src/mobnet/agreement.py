"""Whether files of results say what their places and the configuration say: whose they are, and how they were made.

A run asks of the files that it is about to read, before its first job; `./reproduce check` asks of each file that it is
given. What a file must be by itself is said elsewhere: `mobnet.core.contract` and the readers.
"""

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from itertools import groupby
from math import isclose
from pathlib import Path
from typing import Any

from mobnet.core.columns import STD, Score
from mobnet.core.errors import not_accepted, refuse
from mobnet.core.files import RUN, WEIGHTS
from mobnet.core.notes import read_array_note, read_note
from mobnet.core.store import ARRAY
from mobnet.estimation.kinds.friction import FrictionNote, Options, fitted_joints
from mobnet.evaluation.measure.scores import AVERAGE, ERROR
from mobnet.evaluation.measure.trainings import read_training_note
from mobnet.evaluation.number.rows import read_scores
from mobnet.learning.deployed.weights import read_weights
from mobnet.learning.features import limb_inputs
from mobnet.plan.runs import NETWORKS, Files
from mobnet.settings.evaluation import METRIC

PRINTED = 1e-4  # relative error of numbers with six digits, and of their mean
MISSING = "nothing"
RUN_FIELDS = ("level", "method", "network_seed", "test_seed")  # of a score


def check_agreement(paths: Iterable[Path], files: Files) -> None:
    """Check that files of results agree with their places; the others, and those that are not there, are left out.

    Raises:
        DataError: a file is not the one that belongs to its place, or is not accepted; one line for each fault.
    """
    for path in paths:
        place = path.relative_to(files.results).parts if path.is_relative_to(files.results) else ("",)
        look = LOOKS.get(place[0])
        if look and path.exists():
            refuse(path, look(path, place[1:], files))


def _array(path: Path, place: tuple[str, ...], files: Files) -> Iterator[str]:
    """Yield in what the note of a recording, residual or estimate is not that of its place."""
    *owner, scenario, level, name = place
    found, settings = re.fullmatch(r"s(\d+)\.(parquet|json)", name), files.settings
    if not found or path.suffix == ARRAY or scenario not in settings.scenarios or level not in settings.levels:
        return
    note = read_array_note(path)
    said = {"scenario": scenario, "level": level, "seed": int(found[1]), "rate_hz": settings.rates.data_hz}
    if path.is_relative_to(files.results / "residuals"):
        ratio = settings.levels[level].nominal_mass_ratio
        said |= {"gain_hz": settings.observer.gain_hz, "nominal_mass_ratio": ratio}
    if owner and owner[0] in settings.all_methods:
        said |= _owner(owner[0], int(owner[1].removeprefix("n")), files)
        yield from _scale_faults(note)
    yield from _differences(note, said)
    for terrain in note.get("terrains", ()):
        if terrain not in settings.scenarios[scenario].terrain:
            yield not_accepted("terrains", terrain, settings.scenarios[scenario].terrain)


def _owner(method: str, seed: int, files: Files) -> dict[str, object]:
    """Return what the note of a method's estimate says of the method."""
    source = files.settings.network_source_of(method)
    limbs = files.settings.method(source).limbs
    return {"method": method, "networks": {limb: files.network(source, limb, seed).name for limb in limbs}}


def _scale_faults(note: Mapping[str, Any]) -> Iterator[str]:
    """Yield joints with a standard deviation but without its factor, where any has one."""
    scales = note.get("std_scale") or {}
    for column in note["columns"]:
        signal, _, joint = column["name"].partition(".")
        if scales and signal == STD and joint not in scales:
            yield f"std_scale: {joint!r} is missing; accepted: a factor for each joint with a column of {STD}"


def _network(path: Path, place: tuple[str, ...], files: Files) -> Iterator[str]:
    """Yield in what the weights or the note of a network are not those of its folder."""
    for method in (*files.settings.all_methods, *files.settings.tried):
        for limb in files.settings.method(method).limbs:
            for seed in files.network_seeds(method, limb):
                if files.network(method, limb, seed).name == place[0]:
                    yield from _trained(path, method, limb, seed, files)


def _trained(path: Path, method: str, limb: str, seed: int, files: Files) -> Iterator[str]:
    """Yield in what a file of a network is not that of a method, a limb and a seed."""
    training = files.settings.training(method, limb)
    network = training.network.model_dump(mode="json", exclude_defaults=True)
    name = path.parent.name
    if path.name == WEIGHTS:
        note = read_weights(path)[1]
        inputs = list(limb_inputs(files.settings.layout, training.network).names)
        yield from _differences(vars(note) | note.network, {"name": name, "limb": limb, "inputs": inputs})
        yield from (f"network.{fault}" for fault in _differences(note.network, network))
    if path.name == RUN:
        noted = read_training_note(path.parent)
        said = {"name": name, "method": method, "limb": limb, "seed": seed, "target": training.target}
        yield from _differences(vars(noted), said)
        yield from (f"settings.network.{fault}" for fault in _differences(dict(noted.settings.network), network))
        if noted.diverged and not training.learning.may_diverge:
            yield not_accepted("diverged", True, ["False, without `learning.may_diverge`"])


def _fit(path: Path, place: tuple[str, ...], files: Files) -> Iterator[str]:
    """Yield in what a fit is not the one that the row of its method asks for."""
    settings, method = files.settings, path.stem
    if method not in settings.all_methods or not settings.method(method).fitted:
        return
    note, options = read_note(path, FrictionNote), Options.model_validate(settings.method(method).options)
    yield from _differences(vars(note), {"smoothing_rad_s": options.smoothing_rad_s})
    limbs = [settings.network(method, limb) for limb in settings.method(method).fitted]
    for joint, terms in fitted_joints(settings.layout, options, limbs).items():
        if joint not in note.joints:
            yield f"joints: {joint!r} is missing; accepted: every joint of `methods.{method}.fitted`"
            continue
        for term, value in note.joints[joint].terms().items():
            if value and term not in terms:
                yield not_accepted(f"joints.{joint}: {term}", value, [f"0, as `methods.{method}` fits {terms}"])


def _scores(path: Path, place: tuple[str, ...], files: Files) -> Iterator[str]:
    """Yield in what the rows of scores are not those of a test's runs."""
    scenario = path.stem
    if scenario not in files.settings.tests:
        return
    rows = read_scores(path)
    runs = {(run.level, run.method, run.network_seed, run.test_seed): run for run in files.runs_of(scenario)}
    known = {name: sorted({str(key[k]) for key in runs}) for k, name in enumerate(RUN_FIELDS)}
    known["scenario"] = [scenario]
    for line, row in enumerate(rows, start=2):
        for name, accepted in known.items():
            if str(getattr(row, name)) not in accepted:
                yield not_accepted(f"line {line}: {name}", getattr(row, name), accepted)
        yield from (f"line {line}: {fault}" for fault in _row_faults(row, files))
    for key in runs.keys() - {tuple(getattr(row, name) for name in RUN_FIELDS) for row in rows}:
        yield f"rows: {dict(zip(RUN_FIELDS, key, strict=True))} is missing; accepted: every run of the test"
    yield from _average_faults(rows, files)


def _row_faults(row: Score, files: Files) -> Iterator[str]:
    """Yield what is wrong with the names and the unit of a score."""
    layout = files.settings.layout
    if not re.fullmatch(METRIC, row.metric):
        yield not_accepted("metric", row.metric, ["a name of `mobnet.evaluation.measure`"])
    joints = layout.groups.get(row.limb)
    if joints is None:
        yield not_accepted("limb", row.limb, layout.groups)
    elif row.joint not in (*joints, AVERAGE):
        yield not_accepted("joint", row.joint, [*joints, AVERAGE])
    else:
        units = {layout.unit(joint) for joint in joints if row.joint in (joint, AVERAGE)}
        if row.unit.startswith("N") and row.unit.removesuffix("/s") not in units:
            yield not_accepted("unit", row.unit, units)


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
        average = values.get(AVERAGE, mean)
        if joints and unit in ("N", "N m") and not isclose(average, mean, rel_tol=PRINTED, abs_tol=PRINTED**2):
            yield not_accepted(f"{where}: {AVERAGE}", average, [f"{mean:.6g}, the mean of its joints"])


def _differences(note: Mapping[str, Any], said: Mapping[str, object]) -> Iterator[str]:
    """Yield the keys whose value is another one than is said by place and configuration."""
    for key, value in said.items():
        found = note.get(key, MISSING)
        if found != value:
            yield not_accepted(key, found, [f"{value!r}, as its place and the configuration say"])


LOOKS: Mapping[str, Callable[[Path, tuple[str, ...], Files], Iterator[str]]] = {
    "recordings": _array, "residuals": _array, "estimates": _array, NETWORKS: _network, "fits": _fit, "scores": _scores,
}  # fmt: skip

"""The rule `estimate`: it runs methods on recordings, several side by side, and writes the external torque of each."""

import logging
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from pydantic import ValidationError

from experiments.plan.parts import MethodRun
from experiments.plan.work import TOGETHER_S
from experiments.running.stage import Stage
from experiments.settings.catalogue import Catalogue
from experiments.settings.settings import Settings
from mobnet.core.errors import ConfigError, not_accepted
from mobnet.core.files import WEIGHTS, write_json
from mobnet.core.joints import JointLayout
from mobnet.core.notes import read_array_note
from mobnet.core.store import NOTE, file_of, files_of
from mobnet.estimation.estimate import ObservedRecording, only, rate_of, read_observed, run_segments, write_estimate
from mobnet.estimation.recipe import Recipe, build_estimator, kind_names, kind_of, options_of
from mobnet.learning.deployed.weights import std_scales
from mobnet.robot.description import describe
from mobnet.settings.base import Section
from mobnet.settings.faults import problems
from mobnet.settings.methods import Method, ObserverSettings
from mobnet.settings.networks import Network
from mobnet.settings.reading import Place
from mobnet.settings.robot import RobotTable
from mobnet.settings.surrogate import Level

log = logging.getLogger(__name__)


def estimate(
    robot: RobotTable,
    level: Level,
    gravity_m_s2: float,
    observer: ObserverSettings,
    runs: Sequence[MethodRun],
    recordings: Sequence[Path],
    residuals: Sequence[Path],
    stage: Stage,
    rate_hz: float | None = None,
) -> None:
    """Write the external torque of recordings made at an uncertainty level by several methods, as Table 5 scores it.

    Columns are `tau_ext.<joint>` [N, N m] and, where the method gives it, `std.<joint>`; segments are the recording's,
    and each is run from a fresh state. Recordings, read once for all methods, and their residuals are paths without a
    suffix, in the same order. Networks run at the rate [Hz] of their training alone; without it, any single one is
    accepted. A job that was killed goes on with the method that it was at.

    Raises:
        ConfigError: a method's kind is unknown, it has no such networks, or they do not estimate a joint.
        DataError: a recording, a residual, a network or the fit is damaged, or the rates differ.
    """
    stage.begin()
    layout = describe(robot).layout
    for some in batches(recordings):
        waiting = [run for run in runs if not _has_all(stage, run.outs[some])]
        pairs = zip(recordings[some], residuals[some], strict=True)
        read = [read_observed(layout, recording, residual, rate_hz) for recording, residual in pairs] if waiting else []
        for run in waiting:
            known = robot, level.nominal_mass_ratio, gravity_m_s2, observer
            recipe = Recipe(run.method, run.methods, *known, rate_of(read), run.networks, run.fitted)
            _estimate(recipe, read, [stage.place(out) for out in run.outs[some]], run.joints)
    files: list[Path] = []
    for run in runs:
        for out in run.outs:
            files += files_of(out)
    stage.publish(files)


def _has_all(stage: Stage, outs: Sequence[Path]) -> bool:
    """Return whether a job that was killed has written all of some estimates."""
    return all(stage.has(files_of(out)) for out in outs)


def _estimate(
    recipe: Recipe, read: Sequence[ObservedRecording], outs: Sequence[Path], joints: Sequence[str] | None
) -> None:
    """Write what a method estimates of the joints, or of all that it estimates, in recordings."""
    estimator = build_estimator(recipe)
    shown = joints or estimator.joints
    note = {
        "method": recipe.name,
        "networks": {limb: folder.name for limb, folder in recipe.networks.items()},
        "std_scale": std_scales(folder / WEIGHTS for folder in recipe.networks.values()),
    }
    for one, result, out in zip(read, run_segments(estimator, read), outs, strict=True):
        write_estimate(out, one.recording, only(result, estimator.joints, shown), shown, recipe.layout, note)


def batches(recordings: Sequence[Path]) -> Iterator[slice]:
    """Yield which recordings run side by side: as many as fit into memory, or a single longer one."""
    start = 0
    held_s = 0.0
    for k, stem in enumerate(recordings):
        note = read_array_note(file_of(stem, NOTE))
        duration_s = note["rows"] / note["rate_hz"]
        if k > start and held_s + duration_s > TOGETHER_S:
            yield slice(start, k)
            start = k
            held_s = 0.0
        held_s += duration_s
    yield slice(start, len(recordings))


def method_problems(settings: Settings) -> Iterator[tuple[Place, str]]:
    """Yield the place and the text of every kind, option or key of a method that its kind does not accept."""
    tried = Catalogue(settings).tried
    for name, method in {**settings.methods, **tried}.items():
        place: Place = ("trials",) if name in tried else ("methods", name)
        if method.kind not in kind_names():
            yield (*place, "kind"), not_accepted("kind", method.kind, kind_names())
            continue
        kind = kind_of(name, method)
        section = getattr(kind, "Options", Section)
        try:
            options = section.model_validate(method.options)
        except ValidationError as error:
            found = problems(error, section, method.options)
            yield from (((*place, "options", *inner), text) for inner, text in found)
        else:
            check = getattr(kind, "check", None)
            found = check(method, options, settings.rates.data_hz) if check else ()
            yield from (((*place, *inner), text) for inner, text in found)


def write_fit(
    layout: JointLayout,
    observer: ObserverSettings,
    method: Method,
    networks: Mapping[str, Network],
    training: Mapping[str, Sequence[tuple[Path, Path]]],
    out: Path,
) -> None:
    """Fit a method to training sets and write what `build` of its kind reads, as JSON; section 5.2 fits MOB-fric.

    For each of the method's `fitted` limbs there are its network of Table 1, whose joints are fitted, and the stems of
    the recordings and residuals of its training set.

    Raises:
        ConfigError: the method's kind is not one that is fitted, or the limbs are not those that the method names.
        DataError: a recording is damaged.
    """
    kind = kind_of(out.stem, method)
    if not hasattr(kind, "fit") or not method.fitted:
        raise ConfigError(
            f"{out}: method of kind {method.kind!r} with `fitted` {list(method.fitted)} is not fitted; "
            "accepted: a kind with a function `fit`, and one or more limbs"
        )
    if set(method.fitted) != set(training):
        raise ConfigError(not_accepted(f"{out}: limbs to fit", sorted(training), [sorted(method.fitted)]))
    write_json(out, kind.fit(layout, observer, options_of(out.stem, method, kind.Options), networks, training))
    log.info("%s: %s", out, ", ".join(method.fitted))

"""How far the predicted standard deviations can be trusted, uncalibrated and calibrated: on held-out data and in tests.

Held-out rows come from the trainings' own notes: there, the factors are fitted to the first half of the validation data
and tested on the second half. In tests the factors are those that were fitted to all validation data.
"""

# pandas has no complete types, which the strict rules of this folder ask for.
# pyright: standard

import logging
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from experiments.evaluation.compare.pair import read_pair, read_std
from experiments.evaluation.compare.rmse import Spans, parts
from experiments.evaluation.compare.windows import pushed_of
from experiments.evaluation.measure.learning.trainings import NotedCalibration, read_training_note
from experiments.evaluation.number.frames import TRUSTED, typed
from experiments.evaluation.number.scored import AVERAGE
from experiments.plan.runs import Run
from experiments.settings.measures import CalibrationTest, Coverage
from mobnet.core.columns import STD
from mobnet.core.errors import DataError
from mobnet.core.files import RUN
from mobnet.core.joints import JointLayout
from mobnet.core.notes import read_array_note
from mobnet.core.store import NOTE, file_of
from mobnet.learning.calibration import Fit, fit_of

log = logging.getLogger(__name__)

VALIDATION = "validation"  # name of held-out data where other rows have the name of a test
STAGES = ("before", "after")  # of the scaling; also keys of a training's note
COVERAGE, NLL, CRPS = "coverage", "nll", "crps"
CASE = ["scenario", "level", "pushed", "method", "limb", "unit"]  # columns of `TRUSTED`: what a number is of


def case_of(scenario: str, level: str, pushed: str) -> str:
    """Return the name of a case in table and figure: of a test, or of held-out data by level."""
    words = scenario, level if scenario == VALIDATION else "", "pushed" if pushed else ""
    return ", ".join(word.replace("_", " ") for word in words if word)


def limb_columns(layout: JointLayout, joints: Sequence[str]) -> dict[tuple[str, str], list[int]]:
    """Return (limb, unit) -> columns of those of some joints (n,) that are its; the virtual joints have two units."""
    columns: dict[tuple[str, str], list[int]] = {}
    for limb, members in layout.groups.items():
        for joint in members:
            if joint in joints:
                columns.setdefault((limb, layout.unit(joint)), []).append(list(joints).index(joint))
    return columns


def measures_of(fits: Sequence[Fit], columns: Sequence[int], shares: Sequence[float]) -> Iterator[dict[str, object]]:
    """Yield the measures of a limb, means over some joints: `stage`, `metric`, `share` and `value`, columns `TRUSTED`.

    The fits are those of the `STAGES`, the shares (k,) those whose coverage they have.
    """
    for stage, fit in zip(STAGES, fits, strict=True):
        for share, contained in zip(shares, fit.coverage[:, columns].mean(axis=1), strict=True):
            yield {"stage": stage, "metric": COVERAGE, "share": share, "value": float(contained)}
        yield {"stage": stage, "metric": NLL, "value": float(fit.nll[columns].mean())}
        yield {"stage": stage, "metric": CRPS, "value": float(fit.crps[columns].mean())}


def held_out(layout: JointLayout, folders: Mapping[str, Sequence[Path]], shares: Sequence[float]) -> pd.DataFrame:
    """Return what trainings noted of their validation data, those that diverged left out: columns `TRUSTED`.

    The trained networks are given by the level that they learned at. Held-out data take the place of a single test.

    Raises:
        DataError: a note is missing, or has the coverage of other nominal shares than these (k,).
    """
    rows: list[dict[str, object]] = []
    for level, trained in folders.items():
        for number, folder in enumerate(trained):
            note = read_training_note(folder)
            if note.diverged:
                log.info("%s: diverged, left out", folder / RUN)
                continue
            fits = noted_fits(folder / RUN, note.calibration, shares)
            place = {"scenario": VALIDATION, "level": level, "pushed": "", "method": note.method}
            for (limb, unit), columns in limb_columns(layout, note.calibration.joints).items():
                of = {**place, "limb": limb, "joint": AVERAGE, "unit": unit, "network_seed": number, "test_seed": 0}
                rows += [{**of, **measure} for measure in measures_of(fits, columns, shares)]
    return in_cases(typed(rows, TRUSTED))


def noted_fits(path: Path, noted: NotedCalibration, shares: Sequence[float]) -> list[Fit]:
    """Return what the note of a training says of its standard deviations, uncalibrated and calibrated.

    Raises:
        DataError: the coverage is that of other nominal shares than these (k,).
    """
    if noted.shares != list(shares):
        raise DataError(f"{path}: coverage of shares {noted.shares}, but {list(shares)} are asked for")
    fits: list[Fit] = []
    for stage in STAGES:
        fit = getattr(noted, stage)
        coverage, nll, crps = (np.array(values, dtype=np.float64) for values in (fit.coverage, fit.nll, fit.crps))
        fits.append(Fit(coverage, nll, crps))
    return fits


def in_tests(
    layout: JointLayout, coverage: Coverage, tests: Sequence[CalibrationTest], runs: Sequence[Sequence[Run]],
    shares: Sequence[float],
) -> pd.DataFrame:  # fmt: skip
    """Return what the runs of each test show of their standard deviations: columns `TRUSTED`.

    The shares (k,) are nominal; the section of coverage says what counts as a push.
    """
    rows: list[dict[str, object]] = []
    for test, runs_of_test in zip(tests, runs, strict=True):
        pushed = pushed_of(test, coverage)
        before = len(rows)
        for run in runs_of_test:
            spans = pushed.spans(run.recording) if pushed else None
            seeds = {"network_seed": run.network_seed, "test_seed": run.test_seed}
            place = {"scenario": test.scenario, "level": test.level, "pushed": test.pushed or "", "method": run.method}
            for (limb, unit), measures in run_measures(layout, run, spans, shares):
                of = {**place, **seeds, "limb": limb, "joint": AVERAGE, "unit": unit}
                rows += [{**of, **measure} for measure in measures if limb in test.limbs]
        if len(rows) == before:
            log.warning("%s: no push or no such limb in its %d runs", test.scenario, len(runs_of_test))
    return in_cases(typed(rows, TRUSTED))


def in_cases(rows: pd.DataFrame) -> pd.DataFrame:
    """Return rows with those of a case together, in the order of their first ones; a limb of two units is two cases."""
    parts = [same for _, same in rows.groupby(CASE, sort=False)]
    return pd.concat(parts, ignore_index=True) if parts else rows


def run_measures(
    layout: JointLayout, run: Run, spans: Spans | None, shares: Sequence[float]
) -> Iterator[tuple[tuple[str, str], list[dict[str, object]]]]:
    """Yield limb and unit, and the measures of a run, limb by limb, for nominal shares (k,).

    A limb whose network has run under an earlier seed is left out. Of the rows, the stretches `spans` count, or all if
    it is None; if there are no stretches, nothing is yielded.

    Raises:
        DataError: a file or column is missing, such as those of standard deviations, or files do not belong together.
    """
    if spans == ():
        return
    pair = read_pair(run, layout)
    std = read_std(run, pair.joints)
    if std is None:
        raise DataError(f"{run.estimate}.json: columns {STD}.<joint> are missing")
    noted = read_array_note(file_of(run.estimate, NOTE)).get("std_scale", {})
    factors = np.array([noted.get(joint, 1.0) for joint in pair.joints])
    arrays = pair.estimate.astype(np.float64) - pair.truth, std.astype(np.float64)
    error, scaled = (np.concatenate(parts(array, spans or pair.spans)) for array in arrays)
    # What is stored is calibrated; without the factors, which validation data gave (docs/notes/sigma.md), it is as
    # learned.
    fits = [fit_of(error, stds, shares) for stds in (scaled / factors, scaled)]
    for (limb, unit), columns in limb_columns(layout, pair.joints).items():
        if limb not in run.repeated:
            yield (limb, unit), list(measures_of(fits, columns, shares))

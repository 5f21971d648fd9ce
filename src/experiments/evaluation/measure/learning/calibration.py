"""How far the predicted standard deviations can be trusted, uncalibrated and calibrated: on held-out data and in tests.

Held-out rows come from the trainings' own notes: there, the factors are fitted to the first half of the validation data
and tested on the second half. In tests the factors are those that were fitted to all validation data.
"""

import logging
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from experiments.evaluation.compare.pair import read_pair, read_std
from experiments.evaluation.compare.rmse import Spans, parts
from experiments.evaluation.compare.windows import pushed_of
from experiments.evaluation.measure.learning.trainings import NotedCalibration, read_training_note
from experiments.evaluation.number.scored import robots_of
from experiments.plan.runs import Run
from experiments.settings.measures import CalibrationTest, Coverage
from mobnet.core.arrays import Array
from mobnet.core.columns import STD
from mobnet.core.errors import DataError
from mobnet.core.files import RUN
from mobnet.core.joints import JointLayout
from mobnet.core.notes import read_array_note
from mobnet.core.store import NOTE, file_of
from mobnet.learning.calibration import Fit, fit_of

log = logging.getLogger(__name__)

Key = tuple[str, str, str]  # method, limb, unit of its torques
VALIDATION = "validation"  # name of held-out data where other rows have the name of a test
STAGES = ("before", "after")  # of the scaling; also keys of a training's note


@dataclass(frozen=True)
class CoverageGrid:
    """Measures of one limb of a method in one test, or in VALIDATION, at one level.

    Where only samples around pushes count, `pushed` is the joint that is pushed, else it is empty. Values are means
    over the limb's joints (networks, tests, 2, k + 2), uncalibrated and calibrated: coverage of k nominal shares,
    negative log-likelihood [nats] and CRPS [unit]. `robots` has the seed of each network's robot, where these are
    robots.
    """

    test: str
    level: str
    pushed: str
    method: str
    limb: str
    unit: str
    values: Array
    robots: tuple[int, ...] = ()

    @property
    def case(self) -> str:
        """Name of the test in table and figure."""
        parts = self.test, self.level if self.test == VALIDATION else "", "pushed" if self.pushed else ""
        return ", ".join(part.replace("_", " ") for part in parts if part)


def limb_columns(layout: JointLayout, joints: Sequence[str]) -> dict[tuple[str, str], list[int]]:
    """Return (limb, unit) -> columns of those of some joints (n,) that are its; the virtual joints have two units."""
    found: dict[tuple[str, str], list[int]] = {}
    for limb, members in layout.groups.items():
        for joint in members:
            if joint in joints:
                found.setdefault((limb, layout.unit(joint)), []).append(list(joints).index(joint))
    return found


def numbers_of(fit: Fit, columns: Sequence[int]) -> Array:
    """Return coverage, likelihood [nats] and CRPS [N m], means over some joints, in one row (k + 2,)."""
    return np.array([*fit.coverage[:, columns].mean(axis=1), fit.nll[columns].mean(), fit.crps[columns].mean()])


def held_out(layout: JointLayout, folders: Mapping[str, Sequence[Path]], shares: Sequence[float]) -> list[CoverageGrid]:
    """Return what trainings noted of their validation data, (networks, 1, 2, k + 2), those that diverged left out.

    The trained networks are given by the level that they learned at.

    Raises:
        DataError: a note is missing, or has the coverage of other nominal shares than these (k,).
    """
    found: dict[tuple[str, Key], list[Array]] = {}
    for level, own in folders.items():
        for folder in own:
            note = read_training_note(folder)
            if note.diverged:
                log.info("%s: diverged, left out", folder / RUN)
                continue
            fits = noted_fits(folder / RUN, note.calibration, shares)
            for (limb, unit), columns in limb_columns(layout, note.calibration.joints).items():
                cell = np.array([numbers_of(fit, columns) for fit in fits])
                found.setdefault((level, (note.method, limb, unit)), []).append(cell)
    grids: list[CoverageGrid] = []
    for (level, key), cells in found.items():
        # Held-out data take the place of a single test.
        grids.append(CoverageGrid(VALIDATION, level, "", *key, np.array(cells)[:, None]))
    return grids


def noted_fits(path: Path, noted: NotedCalibration, shares: Sequence[float]) -> list[Fit]:
    """Return what the note of a training says of its standard deviations, uncalibrated and calibrated.

    Raises:
        DataError: the coverage is that of other nominal shares than these (k,).
    """
    if noted.shares != list(shares):
        raise DataError(f"{path}: coverage of shares {noted.shares}, but {list(shares)} are asked for")
    fits: list[Fit] = []
    for stage in STAGES:
        own = getattr(noted, stage)
        coverage, nll, crps = (np.array(values, dtype=np.float64) for values in (own.coverage, own.nll, own.crps))
        fits.append(Fit(coverage, nll, crps))
    return fits


def in_tests(
    layout: JointLayout, coverage: Coverage, tests: Sequence[CalibrationTest], runs: Sequence[Sequence[Run]],
    shares: Sequence[float],
) -> list[CoverageGrid]:  # fmt: skip
    """Return what the runs of each test show of their standard deviations, (networks, tests, 2, k + 2) each.

    The shares (k,) are nominal; the section of coverage says what counts as a push.
    """
    grids: list[CoverageGrid] = []
    for test, own in zip(tests, runs, strict=True):
        pushed = pushed_of(test, coverage)
        cells = defaultdict[Key, dict[tuple[int, int], Array]](dict)
        for run in own:
            spans = pushed.spans(run.recording) if pushed else None
            for (limb, unit), cell in run_cells(layout, run, spans, shares):
                if limb in test.limbs:
                    cells[run.method, limb, unit][run.network_seed, run.test_seed] = cell
        if not cells:
            log.warning("%s: no push or no such limb in its %d runs", test.scenario, len(own))
        head = test.scenario, test.level, test.pushed or ""
        for key, found in cells.items():
            robots = robots_of(sorted({network for network, _ in found}))
            grids.append(CoverageGrid(*head, *key, grid_of(found), robots))
    return grids


def run_cells(
    layout: JointLayout, run: Run, spans: Spans | None, shares: Sequence[float]
) -> Iterator[tuple[tuple[str, str], Array]]:
    """Yield limb and unit, and the measures (2, k + 2) of a run, limb by limb, for nominal shares (k,).

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
    fits = [fit_of(error, one, shares) for one in (scaled / factors, scaled)]
    own = {key: columns for key, columns in limb_columns(layout, pair.joints).items() if key[0] not in run.repeated}
    for key, columns in own.items():
        yield key, np.array([numbers_of(fit, columns) for fit in fits])


def grid_of(runs: Mapping[tuple[int, int], Array]) -> Array:
    """Return the cells of runs (network seed, test seed) as one array (networks, tests, ...) [their units].

    Each robot has tests of its own.

    Raises:
        DataError: a network misses a test.
    """
    networks = sorted({network for network, _ in runs})
    tests = sorted({test for _, test in runs})
    rows: list[list[Array]] = []
    for network in networks:
        rows.append([runs[network, test] for test in tests if (network, test) in runs])
    expected = len(rows[0]) if robots_of(networks) else len(tests)
    if any(len(own) != expected for own in rows):
        raise DataError(f"runs {sorted(runs)}; expected one for each of networks {networks} on tests {tests}")
    return np.array(rows)

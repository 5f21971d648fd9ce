"""How far the predicted standard deviations can be trusted, as learned and scaled: held out, in tests, under collision.

Held-out rows come from the trainings' own notes: there, the first half of the validation data gave the factors and the
second half shows what they do. In tests the factors are those that all validation data gave.
"""

from __future__ import annotations

import logging
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.columns import STD, named
from mobnet.core.config import load_layout
from mobnet.core.errors import DataError
from mobnet.core.files import read_json
from mobnet.core.joints import JointLayout
from mobnet.core.store import NOTE, read_array
from mobnet.evaluation.measure.metrics import parts
from mobnet.evaluation.measure.scores import read_pair
from mobnet.evaluation.measure.windows import pushed_of
from mobnet.learning.gaussian import Fit, fit_of

log = logging.getLogger(__name__)

Array = NDArray[np.float64]
Key = tuple[str, str, str]  # method, limb, unit of its torques
VALIDATION = "validation"  # what the rows of held-out data are called
STAGES = ("before", "after")  # the scaling; keys of a training's note too


@dataclass(frozen=True)
class Grid:
    """Measures of one limb of a method in one test.

    Attributes:
        test: scenario, or VALIDATION.
        level: uncertainty level; empty for held-out data.
        pushed: joint that is pushed where only samples around pushes count, else empty.
        method: row of the configuration's methods.
        limb: limb of section 4.1.
        unit: unit of the limb's torques.
        values: means over the limb's joints (networks, tests, 2, k + 2): as learned and scaled; coverage of k nominal
            shares [-], negative log-likelihood [nats] and CRPS [N m].
    """

    test: str
    level: str
    pushed: str
    method: str
    limb: str
    unit: str
    values: Array


def limb_columns(layout: JointLayout, joints: Sequence[str]) -> dict[tuple[str, str], list[int]]:
    """Return (limb, unit) -> columns of those of some joints (n,) that are its; the virtual joints have two units."""
    found: dict[tuple[str, str], list[int]] = {}
    for limb, members in layout.groups.items():
        for joint in members:
            if joint in joints:
                found.setdefault((limb, layout.unit(joint)), []).append(list(joints).index(joint))
    return found


def numbers_of(fit: Fit, columns: Sequence[int]) -> Array:
    """Return coverage [-], likelihood [nats] and CRPS [N m], means over some joints, in one row (k + 2,)."""
    return np.array([*fit.coverage[:, columns].mean(axis=1), fit.nll[columns].mean(), fit.crps[columns].mean()])


def held_out(layout: JointLayout, folders: Sequence[str], shares: Sequence[float]) -> list[Grid]:
    """Return what trainings noted of their validation data, (networks, 1, 2, k + 2), those that diverged left out.

    Args:
        layout: joints.
        folders: of the trained networks.
        shares: nominal shares (k,) [-].

    Raises:
        DataError: a note is missing, or tells the coverage of other shares.
    """
    found: dict[Key, list[Array]] = {}
    for folder in folders:
        path = Path(folder) / "run.json"
        note = read_json(path)
        if note["diverged"]:
            log.info("%s: diverged, left out", path)
            continue
        told = note["calibration"]
        if told["shares"] != list(shares):
            raise DataError(f"{path}: coverage of shares {told['shares']}, but {list(shares)} are asked for")
        fits = [Fit(**{name: np.array(values) for name, values in told[stage].items()}) for stage in STAGES]
        for (limb, unit), columns in limb_columns(layout, told["joints"]).items():
            cell = np.array([numbers_of(fit, columns) for fit in fits])
            found.setdefault((note["method"], limb, unit), []).append(cell)
    return [Grid(VALIDATION, "", "", *key, np.array(cells)[:, None]) for key, cells in found.items()]


def in_tests(config: Mapping[str, Any], tests: Sequence[Mapping[str, Any]], shares: Sequence[float]) -> list[Grid]:
    """Return what runs show of their standard deviations, (networks, tests, 2, k + 2) each.

    Args:
        config: resolved configuration: `robot`, and push_nm [N m] and push_after_s [s] of `evaluation.coverage`.
        tests: scenario, level, `limbs`, `runs`, each with method, seeds and the stems of its files, and `pushed`, a
            joint, where only samples around pushes count.
        shares: nominal shares (k,) [-].

    Raises:
        DataError: a file or a column is missing, or an estimate has no standard deviation.
    """
    layout, grids = load_layout(Path(config["robot"])), []
    for test in tests:
        cells: dict[Key, dict[tuple[int, int], Array]] = {}
        for run in test["runs"]:
            for key, cell in run_cells(config, layout, test, run, shares):
                cells.setdefault(key, {})[run["network_seed"], run["test_seed"]] = cell
        if not cells:
            log.warning("%s: no push or no such limb in its %d runs", test["scenario"], len(test["runs"]))
        head = test["scenario"], test["level"], test.get("pushed", "")
        grids += [Grid(*head, *key, grid_of(runs)) for key, runs in cells.items()]
    return grids


def run_cells(
    config: Mapping[str, Any],
    layout: JointLayout,
    test: Mapping[str, Any],
    run: Mapping[str, Any],
    shares: Sequence[float],
) -> Iterator[tuple[Key, Array]]:
    """Yield method, limb and unit, and the measures (2, k + 2) of each limb of a run; none without a push."""
    pushed = pushed_of(test, config["evaluation"]["coverage"])
    spans = pushed.spans(Path(run["recording"])) if pushed else None
    if spans == ():
        return
    told = read_told(Path(run["estimate"]), Path(run["residual"]), layout)
    error, std = (np.concatenate(parts(array, spans or told.spans)) for array in (told.error, told.std))
    fits = [fit_of(error, one, shares) for one in (std / told.scale, std)]
    for (limb, unit), columns in limb_columns(layout, told.joints).items():
        if limb in test["limbs"]:
            yield (run["method"], limb, unit), np.array([numbers_of(fit, columns) for fit in fits])


@dataclass(frozen=True)
class Told:
    """What an estimate tells of its own error.

    Attributes:
        joints: names (n,).
        error: estimate minus low-passed truth (T, n) [N m].
        std: standard deviation that it names (T, n) [N m].
        scale: factors that this holds (n,) [-].
        spans: contiguous stretches (start, end) of rows.
    """

    joints: tuple[str, ...]
    error: Array
    std: Array
    scale: Array
    spans: tuple[tuple[int, int], ...]


def read_told(estimate: Path, residual: Path, layout: JointLayout) -> Told:
    """Read an estimate with its standard deviation and error (T, n) [N m], V1..V3 [N].

    Raises:
        DataError: a file or a column is missing, or the two do not belong together.
    """
    pair = read_pair(estimate, residual, layout)
    scale = read_json(estimate.with_suffix(NOTE)).get("std_scale", {})
    return Told(
        pair.joints,
        pair.estimate.astype(np.float64) - pair.truth,
        read_array(estimate, named(STD, pair.joints))[0].astype(np.float64),
        np.array([scale.get(joint, 1.0) for joint in pair.joints]),
        pair.spans,
    )


def grid_of(runs: Mapping[tuple[int, int], Array]) -> Array:
    """Return the cells of runs (network seed, test seed) as one array (networks, tests, ...) [their units].

    Raises:
        DataError: a network misses a test.
    """
    networks, tests = (sorted({key[axis] for key in runs}) for axis in (0, 1))
    if len(runs) != len(networks) * len(tests):
        raise DataError(f"runs {sorted(runs)}; expected one for each of networks {networks} on tests {tests}")
    return np.array([[runs[network, test] for test in tests] for network in networks])


def case_name(test: str, pushed: str) -> str:
    """Return the name of a test in table and figure."""
    return test.replace("_", " ") + (", pushed" if pushed else "")

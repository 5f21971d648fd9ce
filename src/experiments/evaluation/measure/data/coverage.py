"""How far the training data cover the inputs that occur in tests, with and without random torque exploration.

Measures beside Figure 19: the part of the velocity-torque plane that a training set visits, joint by joint; the share
of test samples outside a training set's central range, pooled, and of the torque also given the gait's phase and given
the joint's position and velocity; how wide these ranges are; and the distance of a test sample to its nearest neighbour
in training, in the inputs of a limb's network (Table 1). Both sets have equally many samples.
"""

import logging
from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from experiments.evaluation.compare.windows import pushed_of
from experiments.evaluation.measure.data.conditional import TorqueRange, even_cells, torque_range
from experiments.evaluation.measure.data.samples import Blocks, Reference, equal_sets, read_blocks, refer, scale_of
from experiments.evaluation.number.number import Number
from experiments.intervals.crossed import RATIO, RunGrid, quantile_of, summarise
from experiments.settings.measures import Coverage, CoverageTest
from experiments.settings.runs import Statistics
from mobnet.core.columns import DESIRED, FEET, VELOCITY, foot_of
from mobnet.core.joints import JointLayout
from mobnet.formats.network import Limb
from mobnet.learning.features import limb_inputs

log = logging.getLogger(__name__)

WITHOUT = "without RTE"  # name of the training set without exploration
OUTSIDE = {VELOCITY: "outside velocity", DESIRED: "outside torque"}
AREA = "visited cells"
AIR_AREA = "visited cells, swing"
NEAREST = {"nearest, median": 0.5, "nearest, 95 %": 0.95}
ALL = "all"  # joints together
PHASE = "phase"
GIVEN = {"phase": (PHASE,), "position and velocity": ("q", VELOCITY)}  # conditions of a joint's torque
WIDTH = {condition: f"torque range given {condition} [N m]" for condition in GIVEN}
BEYOND = {condition: f"outside torque given {condition}" for condition in GIVEN}

Ranges = Mapping[tuple[str, str], Sequence[TorqueRange]]  # condition, joint -> of each training set
Samples = Sequence[NDArray[Any]]  # of each training set, (n, n_in)
Row = dict[str, Any]  # column of COVERAGE -> value


def row_of(
    scenario: str, level: str, measure: str, joint: str, block_count: int, pair: Sequence[float], ratio: Number
) -> Row:  # fmt: skip
    """Return one measure of a test against training sets with and without random torque exploration: a row of COVERAGE.

    The measure is AREA, AIR_AREA or a value of OUTSIDE or BEYOND, all shares, a value of WIDTH [N m], or a name of
    NEAREST, a distance in z-scored inputs; the joint may be ALL, the mean over joints or inputs together. The scenario
    is `training` and has no level and no block where no test is needed; else its samples come in blocks, each
    contiguous in time. The ratio, with over without, has its interval over blocks, and where no test is needed over
    stretches of the training walks; shares of test samples have none, as they may be zero.
    """
    have, lack = pair
    value, low, high = ratio.with_ends
    place = {"scenario": scenario, "level": level, "measure": measure, "joint": joint, "block_count": block_count}
    return {**place, "with_rte": have, "without_rte": lack, "ratio": value, "low": low, "high": high}


def covered(
    settings: Coverage, layout: JointLayout, ports: Limb, statistics: Statistics,
    explored: Sequence[Path], plain: Sequence[Path], tests: Sequence[Sequence[Path]],
) -> pd.DataFrame:  # fmt: skip
    """Return all measures of two training sets, with and without exploration, and of tests against them: COVERAGE.

    `ports` are what the network of the leg sees.
    """
    inputs = limb_inputs(layout, ports)
    joints = layout.limb(settings.limb)
    foot = FEET.index(foot_of(layout, joints[0]))
    sets = [explored, plain]
    # The larger of two sets would visit more cells and lie nearer to any sample: both have equally many.
    samples = equal_sets([read_blocks(stems, layout, inputs, settings) for stems in sets], settings.samples)
    airborne = equal_sets([read_blocks(stems, layout, inputs, settings, foot) for stems in sets], settings.samples)
    names = (*inputs.names, PHASE)
    bare = [array[:, :-1] for array in samples]
    # One scale for both sets, so that distances to the two compare.
    mean, std = scale_of(np.concatenate(bare))
    references = [refer(array, settings.range, mean, std) for array in bare]
    ranges = conditional(samples, names, joints, settings)
    in_training = training_rows(samples, airborne, names, joints, settings)
    left_out: list[list[Row]] = []
    for part in range(settings.parts):
        kept = [without_part(both, part, settings.parts) for both in (samples, airborne)]
        left_out.append(training_rows(kept[0], kept[1], names, joints, settings))
    rows = [with_interval(row, left_out, statistics) for row in in_training]
    for test, stems in zip(settings.tests, tests, strict=True):
        blocks = read_blocks(stems, layout, inputs, settings, pushed=pushed_of(test, settings))
        if not blocks:
            log.warning("%s: no push is found in its %d recordings", test.scenario, len(stems))
            continue
        seen = [block[:, :-1] for block in blocks]
        rows += outside(test, seen, references, inputs.names, joints)
        rows += beyond(test, blocks, ranges, names)
        rows += nearest(test, [(block - mean) / std for block in seen], references, statistics)
    return pd.DataFrame(rows)


def training_rows(
    samples: Samples, airborne: Samples, names: Sequence[str], joints: Sequence[str], settings: Coverage
) -> list[Row]:
    """Return what two training sets hold without regard to tests, of all samples (n, n_in) and of those in the air."""
    return [
        *visited(AREA, samples, names, joints, settings),
        *visited(AIR_AREA, airborne, names, joints, settings),
        *widths(conditional(samples, names, joints, settings)),
    ]


def without_part(sets: Samples, part: int, parts: int) -> list[NDArray[Any]]:
    """Return the samples (n, n_in) of each set without one of so many equal stretches of time."""
    parts_left: list[NDArray[Any]] = []
    for array in sets:
        edges = np.linspace(0, len(array), parts + 1).astype(int)
        parts_left.append(np.delete(array, slice(edges[part], edges[part + 1]), axis=0))
    return parts_left


def with_interval(row: Row, left_out: Sequence[Sequence[Row]], statistics: Statistics) -> Row:
    """Return a row with the interval of its ratio over stretches of the training walks, on a log scale.

    `left_out` are the rows without each of them. The jackknife stands for other walks: what changes little when a
    stretch is left out would change little in another walk. There is no interval where a row lacks one of its ratios.
    """
    ratios: list[float | None] = []
    for rows in left_out:
        ratios += [other["ratio"] for other in rows if _is_of(row, other)]
    known = [ratio for ratio in ratios if ratio is not None and np.isfinite(ratio) and ratio > 0.0]
    value = row["ratio"]
    if not value or not np.isfinite(value) or len(known) < len(left_out):
        return row
    logs = np.log(known)
    count = len(logs)
    std = float(np.sqrt((count - 1) / count * ((logs - logs.mean()) ** 2).sum()))
    factor = float(np.exp(quantile_of(count - 1, statistics.confidence) * std))
    return {**row, "low": value / factor, "high": value * factor}


def _is_of(row: Row, other: Row) -> bool:
    return (row["measure"], row["joint"]) == (other["measure"], other["joint"])


def visited(
    measure: str, samples: Sequence[NDArray[Any]], names: Sequence[str], joints: Sequence[str], settings: Coverage
) -> Iterator[Row]:
    """Yield the share of a joint's velocity-torque plane that each training set visits (Figure 19).

    The plane is a rectangle of both sets together, without their rarest samples, cut into equal cells. The samples (n,
    n_in) are with and without random torque exploration; their named inputs hold [rad/s] and [N m] of the joints.
    """
    where = {name: column for column, name in enumerate(names)}
    shares = []
    for joint in joints:
        columns = [where[f"{quantity}.{joint}"] for quantity in OUTSIDE]
        planes = [array[:, columns] for array in samples]
        # One rectangle for both sets, without the rarest samples, of which a single one would stretch all cells.
        both = np.concatenate(planes)
        bounds = list(zip(*np.quantile(both, settings.cell_range, axis=0), strict=True))
        shares.append([float(np.mean(np.histogramdd(plane, settings.cells, bounds)[0] > 0)) for plane in planes])
    for joint, (have, lack) in zip([*joints, ALL], [*shares, np.mean(shares, axis=0).tolist()], strict=True):
        yield row_of("training", "", measure, joint, 0, (have, lack), Number(have / lack))


def outside(
    test: CoverageTest, blocks: Blocks, references: Sequence[Reference], names: Sequence[str], joints: Sequence[str]
) -> Iterator[Row]:
    """Yield the share of test samples outside the central range, for each joint and the mean over joints.

    The blocks (n, n_in) and the references, with and without random torque exploration, have these names of inputs
    (n_in,).
    """
    where = {name: column for column, name in enumerate(names)}
    samples = np.concatenate(blocks)
    shares = [np.mean((samples < ref.low) | (samples > ref.high), axis=0) for ref in references]
    for quantity, measure in OUTSIDE.items():
        columns = {joint: [where[f"{quantity}.{joint}"]] for joint in joints}
        for joint, picked in (columns | {ALL: [column for (column,) in columns.values()]}).items():
            pair = [float(share[picked].mean()) for share in shares]
            # Shares may be zero, so that their ratio has no interval.
            yield row_of(test.scenario, test.level, measure, joint, len(blocks), pair, Number(None))


def conditional(
    samples: Sequence[NDArray[Any]], names: Sequence[str], joints: Sequence[str], settings: Coverage
) -> Ranges:
    """Return the torque's range [N m] of each training set in every phase, and in cells of position and velocity.

    The samples (n, n_in) have these names of inputs (n_in,). Cells of position and velocity lie between the rarest
    samples of both sets together.
    """
    ranges: dict[tuple[str, str], list[TorqueRange]] = {}
    for condition, joint in product(GIVEN, joints):
        columns, torque = _columns_of(condition, joint, names)
        cells = even_cells([(0.0, 1.0)], [settings.phases])
        if condition != PHASE:
            ends = np.quantile(np.concatenate(samples)[:, columns], settings.cell_range, axis=0)
            cells = even_cells(list(zip(*ends.tolist(), strict=True)), [settings.state_cells] * len(columns))
        ranges[condition, joint] = [
            torque_range(cells, array[:, columns], array[:, torque], settings.range, settings.cell_samples)
            for array in samples
        ]
    return ranges


def widths(ranges: Ranges) -> Iterator[Row]:
    """Yield the mean width [N m] of the conditional ranges for each joint, and the mean over joints."""
    for condition, measure in WIDTH.items():
        known: dict[str, list[float]] = {}
        for (given, joint), both in ranges.items():
            if given == condition:
                known[joint] = [torques.width for torques in both]
        for joint, (have, lack) in _with_all(known):
            yield row_of("training", "", measure, joint, 0, (have, lack), Number(have / lack))


def beyond(test: CoverageTest, blocks: Blocks, ranges: Ranges, names: Sequence[str]) -> Iterator[Row]:
    """Yield the share of test samples whose torque lies outside its conditional range, by joint and their mean.

    The blocks (n, n_in) have these names of inputs (n_in,). Samples without a phase do not count.
    """
    samples = np.concatenate(blocks)
    for condition, measure in BEYOND.items():
        known: dict[str, list[float]] = {}
        for (given, joint), both in ranges.items():
            if given != condition:
                continue
            columns, torque = _columns_of(condition, joint, names)
            # A swing or stance that is cut by the end of its segment has no phase.
            phased = samples[np.isfinite(samples[:, columns]).all(axis=1)]
            if len(phased):
                known[joint] = [
                    float(torques.outside(phased[:, columns], phased[:, torque]).mean()) for torques in both
                ]
        for joint, pair in _with_all(known):
            yield row_of(test.scenario, test.level, measure, joint, len(blocks), pair, Number(None))


def _columns_of(condition: str, joint: str, names: Sequence[str]) -> tuple[list[int], int]:
    """Return where the conditions of a joint's torque and the torque stand among inputs of these names (n_in,)."""
    wanted = [name if name == PHASE else f"{name}.{joint}" for name in GIVEN[condition]]
    return [names.index(name) for name in wanted], names.index(f"{DESIRED}.{joint}")


def _with_all(known: Mapping[str, Sequence[float]]) -> Iterator[tuple[str, Sequence[float]]]:
    """Yield the pairs of numbers of joints, with and without exploration, that have them, and last their mean."""
    finite = {joint: pair for joint, pair in known.items() if np.isfinite(pair).all()}
    yield from finite.items()
    if finite:
        yield ALL, np.mean(list(finite.values()), axis=0).tolist()


def nearest(
    test: CoverageTest, blocks: Blocks, references: Sequence[Reference], statistics: Statistics
) -> Iterator[Row]:
    """Yield quantiles of the distance to the nearest training sample, means over blocks, and their ratio.

    The blocks (n, n_in) are z-scored; the references are with and without random torque exploration.
    """
    distances: list[list[NDArray[Any]]] = []
    for ref in references:
        distances.append([ref.tree.query(block)[0] for block in blocks])
    for measure, share in NEAREST.items():
        # Neighbouring samples are alike: blocks of time, and not samples, take the place of walks in the interval.
        have, lack = (_quantiles(of_set, share) for of_set in distances)
        ratio = summarise([have, lack], statistics, RATIO)
        yield row_of(test.scenario, test.level, measure, ALL, len(blocks), (have.mean, lack.mean), ratio)


def _quantiles(distances: Sequence[NDArray[Any]], share: float) -> RunGrid:
    """Return a quantile of the distances in each of n blocks, (1, n) [-]."""
    return RunGrid(np.array([[np.quantile(block, share) for block in distances]]))

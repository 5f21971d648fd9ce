"""How far the training data cover the inputs that occur in tests, with and without random torque exploration.

Three measures beside Figure 19: the part of the velocity-torque plane that a training set visits, joint by joint; the
share of test samples outside a training set's central range; and the distance of a test sample to its nearest neighbour
in training, in the inputs of a limb's network (Table 1). Both sets have equally many samples.
"""

import logging
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.columns import DESIRED, FEET, VELOCITY
from mobnet.core.joints import JointLayout
from mobnet.evaluation.measure.samples import Blocks, Reference, equal_sets, read_blocks, refer, scale_of
from mobnet.evaluation.measure.windows import foot_of, pushed_of
from mobnet.evaluation.number.intervals import RATIO, RunGrid, summarise
from mobnet.evaluation.number.number import Number
from mobnet.learning.features import limb_inputs
from mobnet.settings.evaluation import Coverage, CoverageTest, Statistics
from mobnet.settings.networks import Limb

log = logging.getLogger(__name__)

WITH, WITHOUT = "with RTE", "without RTE"  # names of the training sets
OUTSIDE = {VELOCITY: "outside velocity", DESIRED: "outside torque"}
AREA, AIR_AREA = "visited cells", "visited cells, swing"
NEAREST = {"nearest, median": 0.5, "nearest, 95 %": 0.95}
ALL = "all"  # joints together


@dataclass(frozen=True)
class Covered:
    """One measure of a test against both training sets, with and without random torque exploration: a row of the table.

    The measure is AREA, AIR_AREA or a value of OUTSIDE, all shares, or a name of NEAREST, a distance in z-scored
    inputs; the joint may be ALL, the mean over joints or inputs together. The scenario is `training` and has no level
    and no block where no test is needed; else its samples come in blocks, each contiguous in time. The ratio, with over
    without, has its interval over blocks; shares of test samples have none, as they may be zero.
    """

    scenario: str
    level: str
    measure: str
    joint: str
    block_count: int
    with_rte: float
    without_rte: float
    ratio: Number


def covered(
    settings: Coverage, layout: JointLayout, ports: Limb, statistics: Statistics,
    training: Mapping[str, Sequence[Path]], tests: Sequence[Sequence[Path]],
) -> list[Covered]:  # fmt: skip
    """Return all measures of the training sets, WITH and WITHOUT, and of every test against them.

    `ports` are what the network of the leg sees.
    """
    inputs, joints = limb_inputs(layout, ports), layout.limb(settings.limb)
    foot, sets = FEET.index(foot_of(layout, joints[0])), [training[WITH], training[WITHOUT]]
    samples = equal_sets([read_blocks(stems, layout, inputs, settings) for stems in sets], settings.samples)
    airborne = equal_sets([read_blocks(stems, layout, inputs, settings, foot) for stems in sets], settings.samples)
    mean, std = scale_of(np.concatenate(samples))
    references = [refer(array, settings.range, mean, std) for array in samples]
    rows = [
        *visited(AREA, samples, inputs.names, joints, settings),
        *visited(AIR_AREA, airborne, inputs.names, joints, settings),
    ]
    for test, stems in zip(settings.tests, tests, strict=True):
        blocks = read_blocks(stems, layout, inputs, settings, pushed=pushed_of(test, settings))
        if not blocks:
            log.warning("%s: no push is found in its %d recordings", test.scenario, len(stems))
            continue
        rows += outside(test, blocks, references, inputs.names, joints)
        rows += nearest(test, [(block - mean) / std for block in blocks], references, statistics)
    return rows


def visited(
    measure: str, samples: Sequence[NDArray[Any]], names: Sequence[str], joints: Sequence[str], settings: Coverage
) -> Iterator[Covered]:
    """Yield the share of a joint's velocity-torque plane that each training set visits (Figure 19).

    The plane is a rectangle of both sets together, without their rarest samples, cut into equal cells. The samples (n,
    n_in) are with and without random torque exploration; their named inputs hold [rad/s] and [N m] of the joints.
    """
    where = {name: column for column, name in enumerate(names)}
    shares = []
    for joint in joints:
        planes = [array[:, [where[f"{quantity}.{joint}"] for quantity in OUTSIDE]] for array in samples]
        both = np.concatenate(planes)
        bounds = list(zip(*np.quantile(both, settings.cell_range, axis=0), strict=True))
        shares.append([float(np.mean(np.histogramdd(plane, settings.cells, bounds)[0] > 0)) for plane in planes])
    for joint, (have, lack) in zip([*joints, ALL], [*shares, np.mean(shares, axis=0).tolist()], strict=True):
        yield Covered("training", "", measure, joint, 0, have, lack, Number(have / lack))


def outside(
    test: CoverageTest, blocks: Blocks, references: Sequence[Reference], names: Sequence[str], joints: Sequence[str]
) -> Iterator[Covered]:
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
            have, lack = (float(share[picked].mean()) for share in shares)
            yield Covered(test.scenario, test.level, measure, joint, len(blocks), have, lack, Number(None))


def nearest(
    test: CoverageTest, blocks: Blocks, references: Sequence[Reference], statistics: Statistics
) -> Iterator[Covered]:
    """Yield quantiles of the distance to the nearest training sample, means over blocks, and their ratio.

    The blocks (n, n_in) are z-scored; the references are with and without random torque exploration.
    """
    distances = [[ref.tree.query(block)[0] for block in blocks] for ref in references]
    for measure, share in NEAREST.items():
        have, lack = (np.array([[np.quantile(block, share) for block in found]]) for found in distances)
        ratio = summarise([RunGrid(have), RunGrid(lack)], statistics, RATIO)
        means = float(have.mean()), float(lack.mean())
        yield Covered(test.scenario, test.level, measure, ALL, len(blocks), *means, ratio)

"""Table of the standard deviations' calibration."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from experiments.evaluation.measure.learning.calibration import STAGES, CoverageGrid
from experiments.evaluation.number.number import Number, interval_text
from experiments.evaluation.number.rows import Field
from experiments.evaluation.tables.layout import Table, in_blocks, write_table
from experiments.intervals.crossed import RunGrid, summarise
from experiments.settings.measures import CalibrationTable
from experiments.settings.runs import Statistics
from experiments.settings.table_columns import CALIBRATION
from mobnet.settings.networks import Learning

COVERAGE = "coverage"
NLL = "nll"
CRPS = "crps"

Trust = Mapping[tuple[str, float | None], tuple[Number, Number]]  # measure, nominal share -> uncalibrated, scaled


def trust_table(
    settings: CalibrationTable,
    learning: Learning,
    statistics: Statistics,
    grids: Sequence[CoverageGrid],
    table_dir: Path,
) -> None:
    """Write calibration.csv, .tex and .md of held-out data and tests; texts hold the methods of `settings` only."""
    trusts = [(grid, trust_of(grid, learning.calibration_levels, statistics)) for grid in grids]
    records: list[tuple[Field, ...]] = []
    blocks: dict[str, list[list[str]]] = {}
    for grid, trust in trusts:
        place = grid.test, grid.level, grid.pushed, grid.method, grid.limb
        for measure, (before, after) in trust.items():
            numbers = *before.with_ends, *after.with_ends, *after.spread
            records.append((*place, *measure, *numbers, grid.unit))
        if grid.method in settings.methods:
            line = [grid.method, grid.limb, *limb_texts(grid, trust, settings, learning)]
            blocks.setdefault(grid.case, []).append(line)
    lines = in_blocks(([test], own) for test, own in blocks.items())
    header = table_header(settings, learning, statistics.confidence)
    align = "lll" + "r" * (len(header) - 4) + "l"
    write_table(table_dir / "calibration", Table(CALIBRATION, records, header, lines, left=3, align=align))


def trust_of(grid: CoverageGrid, levels: Sequence[float], statistics: Statistics) -> Trust:
    """Return the measures of a limb's runs with their intervals: coverage of nominal shares, then NLL and CRPS."""
    measures = [*((COVERAGE, level, k) for k, level in enumerate(levels)), (NLL, None, -2), (CRPS, None, -1)]
    found = {}
    for measure, share, place in measures:
        stages = [grid.values[:, :, stage, place] for stage in range(len(STAGES))]
        before, after = (summarise([RunGrid(values, robots=grid.robots)], statistics) for values in stages)
        found[measure, share] = before, after
    return found


def table_header(settings: CalibrationTable, learning: Learning, confidence: float) -> list[str]:
    """Return the header: coverage of the bar's share uncalibrated, of each level scaled, then NLL [nats] and CRPS."""
    share = f"{learning.calibration_share:.0%}"
    return [
        "Test",
        "Method",
        "Limb",
        f"{share}, uncalibrated",
        *(f"{level:.0%}" for level in learning.calibration_levels),
        f"{confidence:.0%} of {share}",
        "NLL, uncalibrated",
        "NLL",
        "CRPS, uncalibrated",
        "CRPS",
        f"{share} within {settings.tolerance:.0%}",
    ]


def limb_texts(grid: CoverageGrid, trust: Trust, settings: CalibrationTable, learning: Learning) -> list[str]:
    """Return the numbers of a limb as texts: coverage in %, NLL [nats], CRPS with its unit, and the bar's verdict."""
    learned, bar = trust[COVERAGE, learning.calibration_share]
    scaled = [trust[COVERAGE, level][1] for level in learning.calibration_levels]
    ends = [None if end is None else 100.0 * end for end in (bar.low, bar.high)]
    return [
        *(f"{number.value:.1%}" for number in (learned, *scaled)),
        interval_text(*ends, digits=1),
        *(number.text() for number in trust[NLL, None]),
        trust[CRPS, None][0].text(3),
        f"{trust[CRPS, None][1].value:.3f} {grid.unit}",
        verdict(grid, bar, learning.calibration_share, settings.tolerance),
    ]


def verdict(grid: CoverageGrid, bar: Number, share: float, tolerance: float) -> str:
    """Return whether the scaled coverage lies near its nominal share, `yes` or `no`; nothing for a collision."""
    if grid.pushed or bar.value is None:
        return ""
    return "yes" if abs(bar.value - share) <= tolerance else "no"

"""What only the authors of configs/ can get wrong: the robot's two sides, printed numbers, the wording of claims."""

import re
from collections.abc import Iterator, Sequence
from typing import get_args

import numpy as np
import pytest
from paper_settings import settings_at

from experiments.settings.catalogue import Catalogue
from experiments.settings.checks.claims import metrics_of
from experiments.settings.checks.results import Results
from experiments.settings.claims import Bounds, Cell, Claim, MadeNumber, TrainingMetric, numbers_of
from experiments.settings.metrics import unit_of_metric
from experiments.settings.published import ARCHITECTURE
from experiments.settings.tables import ErrorTable
from mobnet.core.joints import right_of
from mobnet.formats.robot import WORLD

SETTINGS = settings_at()
RESULTS = Results(Catalogue(SETTINGS))
ROBOT, PUBLISHED, CLAIMS = SETTINGS.robot, SETTINGS.published, SETTINGS.claims
SAME_M, SAME_SHARE = 0.01, 0.1  # by which the right side may differ from the left one's mirror image
NO_UNIT = ("ratio", "cut", "square cut", "gap ratio", "least ratio", "share")  # quantities without a unit
DIFFER = ("ratio", "cut", "square cut", "difference", "below", "above", "trend")  # their cells are all different
POSSIBLE: dict[str, Bounds] = {
    "value": (0.0, None), "ratio": (0.0, None), "cut": (None, 1.0), "square cut": (None, 1.0), "gap ratio": (0.0, None),
    "least ratio": (0.0, None), "share": (0.0, 1.0),
}  # fmt: skip
MADE = {  # quantity -> what it is of the printed numbers of its cells
    "value": lambda cells: cells[0], "ratio": lambda cells: cells[0] / cells[1],
    "cut": lambda cells: 1.0 - cells[0] / cells[1], "difference": lambda cells: cells[0] - cells[1],
}  # fmt: skip
TYPED = re.compile(r"(?<![A-Za-z0-9-])\.?\d")  # a number; LL3 and FTS-e2e are names
VARIANTS = re.compile(r"(.+?)(-OR|-mean|-sigma)?")  # detectors of sections 5.3 and 6, named after their method


def inside(inner: Bounds, outer: Bounds) -> bool:
    """Return whether a closed range lies inside another one; None is no bound."""
    lower = outer[0] is None or (inner[0] is not None and inner[0] >= outer[0])
    return lower and (outer[1] is None or (inner[1] is not None and inner[1] <= outer[1]))


def test_the_right_side_of_the_robot_is_about_the_mirror_image_of_the_left_in_y() -> None:
    """Bodies of another mass have a content of their own."""
    bodies, joints = {row.name: row for row in ROBOT.bodies}, {row.body: row for row in ROBOT.joints}
    pairs = [(row, bodies[right_of(name)]) for name, row in bodies.items() if right_of(name) != name]
    assert len(pairs) >= 14
    for left, right in pairs:
        assert np.allclose(right.pos, left.pos * np.array([1, -1, 1]), atol=SAME_M), right.name
        assert abs(abs(np.dot(right.quat, left.quat * np.array([1, -1, 1, -1]))) - 1) < SAME_SHARE, right.name
        if abs(right.mass - left.mass) < SAME_SHARE * left.mass:
            image = left.inertia * np.array([1, 1, 1, -1, 1, -1])
            assert np.allclose(right.com, left.com * np.array([1, -1, 1]), atol=SAME_M), right.name
            assert np.allclose(right.inertia, image, atol=SAME_SHARE * max(left.inertia[:3])), right.name
        if left.name in joints:
            one, other = joints[left.name], joints[right.name]
            for name in ("torque_limit", "velocity_limit", "armature"):
                assert getattr(other, name) == pytest.approx(getattr(one, name), rel=SAME_SHARE), other.id
            assert abs(abs(np.dot(other.axis, one.axis * np.array([1, -1, 1]))) - 1) < SAME_SHARE, other.id


def test_the_robot_is_at_least_as_high_as_its_joints_are_apart() -> None:
    place, turn = {WORLD: np.zeros(3)}, {WORLD: np.eye(3)}
    for body in ROBOT.bodies:
        cross = np.cross(np.eye(3), body.quat[1:])
        place[body.name] = place[body.parent] + turn[body.parent] @ body.pos
        turn[body.name] = turn[body.parent] @ (np.eye(3) + 2 * body.quat[0] * cross + 2 * cross @ cross)
    heights = [point[2] for name, point in place.items() if name != WORLD]
    assert ROBOT.totals is not None
    assert max(heights) - min(heights) <= ROBOT.totals.height_m


def shown_of(name: str) -> tuple[dict[str, set[str]], Sequence[str]] | None:
    """Return the places and methods of the paper's numbers that a table or a figure shows, and its columns."""
    evaluation = SETTINGS.evaluation
    if name in evaluation.tables:
        wanted = dict[str, set[str]]()
        for row in evaluation.tables[name].rows:
            wanted.setdefault(row.paper or "", set()).update(row.methods)
        return wanted, RESULTS.column_names(evaluation.tables[name].columns)
    if name == "figure_06":
        return {evaluation.figure_06.level: set(evaluation.figure_06.methods)}, [evaluation.figure_06.joint]
    if name == "figure_10":
        return {row.scenario: set(row.methods) for row in evaluation.figure_10.tests.values()}, ["avg"]
    return None


@pytest.mark.parametrize("name", PUBLISHED.tables)
def test_printed_numbers_stand_where_they_are_shown_and_averages_are_those_of_their_numbers(name: str) -> None:
    table, shown = PUBLISHED.tables[name], shown_of(name)
    if shown is not None:
        assert list(table.columns) == list(shown[1])
        assert all(rows.keys() <= shown[0][place] for place, rows in table.numbers.items())
    for place, rows in table.numbers.items():
        for method, row in rows.items():
            base = VARIANTS.fullmatch(method)
            assert base is not None
            assert base[1] in RESULTS.catalogue.all_methods, method
            assert len(row) == len(table.columns), (place, method)
            assert place != "detected" or all(value is None or value <= 10 for value in row[:-1]), method
            check_averages(table.columns, row)
    assert table.floor is None or table.floor.method in table.numbers[table.floor.level]


def check_averages(columns: Sequence[str], row: Sequence[float | None]) -> None:
    """Check that an average is the mean of the numbers since the last one; `all` may be their sum."""
    since = list[float | None]()
    for column, value in zip(columns, row, strict=True):
        if not column.startswith(("avg", "all")):
            since.append(value)
            continue
        known = [number for number in since if number is not None]
        if value is not None and known:
            near = abs(sum(known) / len(known) - value) <= 0.01 or (column == "all" and value == sum(known))
            assert near, (column, row)
            assert column == "all" or len(known) == len(since), (column, row)
        since = []


def test_printed_sizes_of_networks_and_sets_are_those_of_their_parts() -> None:
    """A GRU of torch has two biases; networks of section 6.1 are of about the same size, and ordered."""
    sizes, kinds = {row.parameters for row in PUBLISHED.table_01.rows.values()}, PUBLISHED.kinds
    for row in PUBLISHED.table_01.rows.values():
        found = re.match(ARCHITECTURE, row.architecture)
        assert found is not None
        inputs, state, width, outputs = map(int, found.groups())
        assert (state, row.parameters) == (width, 3 * state * (inputs + state + 2) + width * outputs + outputs)
    alike = [size for method, size in kinds.parameters.items() if method in kinds.order]
    assert kinds.parameters["GRU"] in sizes
    assert max(alike) <= 1.1 * min(alike)
    assert sorted(kinds.order.values()) == list(range(1, len(kinds.order) + 1))
    assert {*kinds.order, *kinds.parameters} <= {*SETTINGS.evaluation.figure_17.best}
    for said in PUBLISHED.data.sets.values():
        assert 0.0 <= said.get("time standing", 0.0) <= 1.0
        if "duration" in said and "samples" in said:
            assert said["samples"] == said["duration"] * 60.0 * SETTINGS.rates.data_hz
    for limb, values in PUBLISHED.uncertainty.std.items():
        assert len(values) == len(SETTINGS.layout.limb(limb))


def joints_of(cell: Cell) -> list[str]:
    """Return the joints behind a cell of a claim, which may name limbs; none where it names no joint."""
    names = (cell.joint,) if isinstance(cell.joint, str) else cell.joint or ()
    return [joint for name in names for joint in RESULTS.joints(name)]


def units_of(cell: Cell) -> set[str]:
    """Return the units of a cell's numbers; none of a table's."""
    if cell.table:
        return set()
    if metrics_of(cell)[0] in get_args(TrainingMetric):
        return {"N m" if metrics_of(cell) == ("validation RMSE",) else "-"}
    units = {RESULTS.layout.unit(joint) for joint in joints_of(cell)}
    return {unit_of_metric(metric, unit) for metric in metrics_of(cell) for unit in units}


def printed(cell: Cell, joint: str | None) -> float | None:
    """Return the paper's number of a cell, or of one of its joints; None where no table prints it."""
    joints = [joint] if joint else joints_of(cell)
    tables = SETTINGS.evaluation.tables.items()
    found = (one for name, table in tables if name in PUBLISHED.tables for one in in_table(name, table, cell, joints))
    return next(found, None)


def in_table(name: str, table: ErrorTable, cell: Cell, joints: Sequence[str]) -> Iterator[float]:
    """Yield the number that the paper prints in a table of errors for the mean over some joints."""
    columns: list[Sequence[str]] = []
    for column in table.columns:
        whole = RESULTS.joints_of(column)
        columns += [[one] for one in whole] if isinstance(column, str) else [[] if column.metrics else whole]
    for row in table.rows:
        if (row.scenario, row.level, row.metric) == (cell.scenario, cell.level, cell.metric or "rmse"):
            numbers = PUBLISHED.tables[name].numbers.get(row.paper or "", {}).get(str(cell.method), ())
            yield from (
                number
                for column, number in zip(columns, numbers, strict=False)
                if sorted(column) == sorted(joints) and number is not None
            )


@pytest.mark.parametrize("name", CLAIMS)
def test_a_claim_quotes_what_is_printed_and_its_cells_units_and_bounds_fit(name: str) -> None:
    claim = CLAIMS[name]
    for made in numbers_of(claim):
        check_cells(made)
    units = set[str]().union(*map(units_of, claim.cells))
    assert claim.unit == ("-" if claim.quantity in NO_UNIT else next(iter(units), claim.unit))
    assert not claim.statement or not CLAIMS[claim.statement].statement
    assert not claim.by_joint or claim.published is not None
    assert all(set(claim.by_joint) <= set(joints_of(cell)) for cell in claim.cells)
    check_bounds(claim)
    for joint, value in {None: claim.published, **claim.by_joint}.items():
        cells = [printed(cell, joint) for cell in claim.cells if claim.quantity in MADE]
        if value is not None and cells and None not in cells:
            step = 10.0 ** -len(repr(value).partition(".")[2])
            assert MADE[claim.quantity](cells) == pytest.approx(value, abs=step), joint


def check_cells(made: MadeNumber) -> None:
    """Check that cells are in one unit, differ where they are compared, and are shares where they count runs."""
    assert len(set[str]().union(*map(units_of, made.cells))) <= 1
    assert made.quantity not in DIFFER or len(set(map(repr, made.cells))) == len(made.cells)
    assert (made.quantity == "share") == (metrics_of(made.cells[0]) == ("diverged",))


def check_bounds(claim: Claim) -> None:
    """Check that bounds can be met, hold the paper's number and lie in each other, and that causes hold no numbers."""
    possible, paper = POSSIBLE.get(claim.quantity, (None, None)), claim.published
    for bounds in (bound for bound in (claim.bar, None if claim.sign_of else claim.sign) if bound):
        assert all(end is None or inside((end, end), possible) for end in bounds)
        assert paper is None or inside((paper, paper), bounds)
    numbers = [value for value in (paper, *claim.by_joint.values()) if value is not None]
    assert all(inside((value, value), possible) for value in numbers)
    assert not (claim.bar and claim.sign) or claim.sign_of or inside(claim.bar, claim.sign)
    assert claim.cause is None or not TYPED.search(claim.cause.says)

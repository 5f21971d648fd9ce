"""Errors of single joints in a test by method, with intervals and the paper's numbers, as figures show them."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

from experiments.evaluation.number.files import Field
from experiments.evaluation.number.grid import Wanted
from experiments.evaluation.number.lookup import Lookup
from experiments.evaluation.number.number import Number, published_value
from experiments.settings.published import PublishedTable
from experiments.settings.runs import Runs
from mobnet.core.joints import JointLayout

JointErrors = Mapping[str, Mapping[str, Number]]  # joint -> method -> its error [N m], V1..V3 [N]


def joint_errors(
    lookup: Lookup, layout: JointLayout, test: Runs, joints: Sequence[str], metric: str, published: PublishedTable,
    place: str,
) -> JointErrors:  # fmt: skip
    """Return the errors of joints in a test, by method: means over networks and recordings [N m], V1..V3 [N].

    The paper's numbers are those at a place of one of its tables. An error that was not scored has no value.
    """
    limbs = layout.limb_of

    def error(method: str, joint: str) -> Number:
        wanted = Wanted(test.scenario, limbs[joint], test.level, method, joint, metric)
        number = lookup.number([wanted])
        unit = layout.unit(joint)
        return replace(number, unit=unit, published=published_value(published, place, method, joint))

    found: dict[str, dict[str, Number]] = {}
    for joint in joints:
        found[joint] = {method: error(method, joint) for method in test.methods}
    return found


def error_rows(
    test: Runs, metric: str, errors: JointErrors, drawn: Mapping[str, Mapping[str, float]]
) -> list[tuple[Field, ...]]:
    """Return rows of `JOINT_ERRORS`; `drawn` leads from joint and method to the RMSE of what is drawn [N m]."""
    rows: list[tuple[Field, ...]] = []
    for joint, own in errors.items():
        for method, error in own.items():
            of = test.scenario, test.level, method, joint, metric
            measured = *error.with_ends, *error.spread, error.unit, error.published
            rows.append((*of, *measured, drawn[joint].get(method)))
    return rows

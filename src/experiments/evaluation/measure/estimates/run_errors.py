"""Errors of a whole run, and those around its pushes, together and one by one: measured on every test."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

from experiments.evaluation.compare.pair import Measured, Measures, Pair
from experiments.evaluation.compare.rmse import LABELLED, PUSH, PUSHED, RAW, relative_rmse, rmse, roughness
from experiments.evaluation.compare.scene import Scene
from experiments.evaluation.compare.windows import push_windows
from experiments.evaluation.number.grid import Lookup, Wanted
from experiments.evaluation.number.number import Number, published_value
from experiments.evaluation.number.rows import Field
from experiments.settings.published import PublishedTable
from experiments.settings.runs import Runs
from mobnet.core.joints import JointLayout

ERROR = "rmse"
JointErrors = Mapping[str, Mapping[str, Number]]  # joint -> method -> its error [N m], V1..V3 [N]


def measure(pair: Pair, scene: Scene) -> Measures:
    """Yield the errors of a whole run, then those around its pushes, (n,) each.

    Those against the raw truth and against the label of foot sensors have endings of their own.
    """
    yield Measured(ERROR, rmse(pair.estimate, pair.truth, pair.spans))
    yield Measured("roughness", roughness(pair.estimate, pair.spans, pair.rate_hz))
    yield Measured("r_rmse", relative_rmse(pair.estimate, pair.truth, pair.spans))
    raw = scene.external[:, scene.layout.columns(pair.joints)]
    yield Measured(ERROR + RAW, rmse(pair.estimate, raw, pair.spans))
    if pair.label is not None:
        yield Measured(ERROR + LABELLED, rmse(pair.estimate, pair.label, pair.spans))
    window = scene.asked.window
    windows = push_windows(scene.stem, len(raw), window.before_s, window.after_s) if window else ()
    pushes = {PUSHED: windows, **{PUSH.format(k): (one,) for k, one in enumerate(windows, start=1)}}
    for metric, spans in pushes.items() if windows else ():
        for ending, truth in (("", pair.truth), (RAW, raw)):
            yield Measured(metric + ending, rmse(pair.estimate, truth, spans))


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

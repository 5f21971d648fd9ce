"""What a network learns from logs of one's own: inputs of its limb, and the residual less the known external torque."""

from collections.abc import Sequence

import numpy as np

from mobnet.core.arrays import Array
from mobnet.core.columns import EXTERNAL, FEET, named
from mobnet.core.errors import DataError, not_accepted
from mobnet.core.joints import JointLayout
from mobnet.core.recording import ABSENT
from mobnet.core.store import read_array
from mobnet.estimation.label import foot_label
from mobnet.estimation.observe import read_wrenches
from mobnet.estimation.own import RECORDING, OwnLog
from mobnet.estimation.sampling import check_sampling
from mobnet.formats.network import Limb
from mobnet.kernel.low_pass import low_pass
from mobnet.learning.dataset import LimbData
from mobnet.learning.features import limb_inputs
from mobnet.robot.nominal import NominalModel


def label_of(log: OwnLog, nominal: NominalModel, labels: str) -> Array:
    """Return the external torque that is known of a log, behind the observer's low-pass, (T, nv) [N] and [N m].

    Raises:
        DataError: the log does not have the sensors that tell it.
    """
    read = log.recording
    absent = log.recording.meta.get(ABSENT, ())
    if labels == "free":
        return np.zeros(log.residual.shape)
    layout = nominal.robot.layout
    path = log.folder / RECORDING
    needed = ("swing", *(foot for foot in FEET if foot.removesuffix("_foot") in layout.legs))
    missing = [name for name in (needed if labels == "feet" else (EXTERNAL,)) if name in absent]
    if missing or (labels == "feet" and not layout.legs):
        what = "a `tool` in its map" if labels == "tool" else f"{', '.join(needed)} in its map"
        raise DataError(f"{path}: {not_accepted('--labels', labels, ['free'])}; or a log with {what}")
    if labels == "feet":
        return foot_label(nominal, read, read_wrenches(path, nominal.robot), log.sampling.gain_hz)
    # The residual from which it is taken off is behind the low-pass of the observer.
    external = read_array(path, named(EXTERNAL, layout.names))[0]
    parts = [low_pass(external[span], log.sampling.gain_hz, log.sampling.rate_hz) for span in read.spans()]
    return np.concatenate(parts)


def limb_data(logs: Sequence[OwnLog], labels: Sequence[Array], layout: JointLayout, limb: Limb) -> LimbData:
    """Return inputs and targets of a limb in logs, laid end to end.

    Raises:
        DataError: the logs differ in their sampling.
    """
    first = logs[0]
    for log in logs[1:]:
        check_sampling(log.folder, log.sampling, first.sampling, first.folder)
    inputs = limb_inputs(layout, limb)
    joints = layout.limbs(limb.joints)
    columns = layout.columns(joints)
    x = np.concatenate([inputs(log.recording.sensed) for log in logs])
    y = np.concatenate([(log.residual - label)[:, columns] for log, label in zip(logs, labels, strict=True)])
    starts = np.cumsum([0, *(len(log.residual) for log in logs)]).tolist()
    segments = list[tuple[int, int]]()
    for start, log in zip(starts, logs, strict=False):
        segments += [(start + a, start + b) for a, b in log.recording.segments]
    return LimbData(x, y.astype(np.float32), tuple(segments), inputs.names, joints, first.sampling.rate_hz)


def before(data: LimbData, row: int) -> LimbData:
    """Return the data before a row."""
    spans = tuple((start, min(end, row)) for start, end in data.segments if start < row)
    return LimbData(data.inputs[:row], data.targets[:row], spans, data.input_names, data.joints, data.rate_hz)

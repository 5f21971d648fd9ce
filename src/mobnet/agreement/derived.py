"""The numbers of residuals and estimates against those that they were made from."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from mobnet.agreement.said import Signals, difference, signals_of
from mobnet.agreement.walks import UP, WEIGHT, rms
from mobnet.core.columns import EXTERNAL, EXTERNAL_LP, RESIDUAL, named
from mobnet.core.errors import not_accepted
from mobnet.core.joints import JointLayout
from mobnet.core.notes import read_array_note
from mobnet.core.store import NOTE, file_of
from mobnet.estimation.low_pass import low_pass
from mobnet.plan.runs import Files
from mobnet.settings.methods import Method

ZERO, MOB = "zero", "residual"  # kinds of methods: one estimates nothing; one, without networks, the residual


def residual_faults(stem: Path, recording: Path, files: Files) -> Iterator[str]:
    """Yield external torques that are not the recording's behind the low-pass, and a residual that is not theirs."""
    layout, observer = files.settings.layout, files.settings.observer
    if not file_of(recording, NOTE).exists():
        return
    signals = signals_of(stem, [*named(EXTERNAL_LP, layout.names), *named(RESIDUAL, layout.names)])
    truth = signals_of(recording, named(EXTERNAL, layout.names))
    segments, rate = (read_array_note(file_of(stem, NOTE))[key] for key in ("segments", "rate_hz"))
    for joint in layout.names:
        exact, found = truth[f"{EXTERNAL}.{joint}"], signals[f"{EXTERNAL_LP}.{joint}"]
        for start, end in segments:
            wanted = low_pass(exact[start:end, None], observer.gain_hz, rate)[:, 0]
            if apart := difference(found[start:end], wanted):
                accepted = [f"{EXTERNAL}.{joint} of its recording behind the low-pass of (11)"]
                yield not_accepted(f"column {EXTERNAL_LP}.{joint}: difference", apart, accepted)
                break
        if not np.ptp(signals[f"{RESIDUAL}.{joint}"]):
            value = float(signals[f"{RESIDUAL}.{joint}"][0])
            yield not_accepted(f"column {RESIDUAL}.{joint}: every number", value, ["numbers that change"])
    up, wanted = float(signals[f"{RESIDUAL}.{UP}"].mean()), float(signals[f"{EXTERNAL_LP}.{UP}"].mean())
    if not WEIGHT[0] * wanted <= up <= WEIGHT[1] * wanted:
        yield not_accepted(f"column {RESIDUAL}.{UP}: mean", up, [f"about {wanted:.0f} N, the mean external force"])
    yield from _side_faults(signals, layout)


def _side_faults(signals: Signals, layout: JointLayout) -> Iterator[str]:
    """Yield residuals of legs that are nearer to the external torque of the other leg."""
    if len(layout.legs) != 2:
        return
    one, other = (layout.limb(limb) for limb in layout.legs.values())
    apart = {
        swapped: sum(
            rms(signals[f"{RESIDUAL}.{joint}"] - signals[f"{EXTERNAL_LP}.{truth}"])
            for joint, truth in zip((*one, *other), (*other, *one) if swapped else (*one, *other), strict=True)
        )
        for swapped in (False, True)
    }
    if apart[True] < apart[False]:
        text = f"{apart[False]:.1f} N m away from the external torque, and {apart[True]:.1f} from that of the other leg"
        yield not_accepted(f"columns {RESIDUAL}.{one[0]} to {other[-1]}", text, ["each leg's own residual"])


def estimate_faults(stem: Path, residual: Path, method: Method) -> Iterator[str]:
    """Yield estimates that never change, unless the method estimates nothing, and estimates of MOB that are not r."""
    names = [column["name"] for column in read_array_note(file_of(stem, NOTE))["columns"]]
    found = signals_of(stem, [name for name in names if name.startswith(f"{EXTERNAL}.")])
    for name, values in found.items():
        if method.kind == ZERO and values.any():
            yield not_accepted(f"column {name}: largest number", float(np.abs(values).max()), ["0 everywhere"])
        if method.kind != ZERO and len(values) > 1 and not np.ptp(values):
            yield not_accepted(f"column {name}: every number", float(values[0]), ["numbers that change"])
    if method.kind != MOB or method.limbs or method.of or not file_of(residual, NOTE).exists():
        return
    joints = [name.partition(".")[2] for name in found]
    for joint, wanted in zip(joints, signals_of(residual, named(RESIDUAL, joints)).values(), strict=True):
        if apart := difference(found[f"{EXTERNAL}.{joint}"], wanted):
            accepted = [f"{RESIDUAL}.{joint} of its residual, which this method estimates"]
            yield not_accepted(f"column {EXTERNAL}.{joint}: difference", apart, accepted)

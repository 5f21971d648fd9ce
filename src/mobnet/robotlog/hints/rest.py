"""What explains the residual of a log that has no mistake: friction, rotor inertia, an offset, a mass, or the model."""

from collections.abc import Iterator

import numpy as np

from mobnet.robot.nominal import NominalModel
from mobnet.robotlog.hints.fits import friction_fit, quotient
from mobnet.robotlog.hints.payload import payloads
from mobnet.robotlog.hints.windows import MotionWindows, known_joints, left_of, size_of
from mobnet.settings.robotlog import RobotLog

HALF = 0.5  # share of a residual that must be explained for a word


def explanation(nominal: NominalModel, windows: MotionWindows, bounds: RobotLog) -> Iterator[str]:
    """Yield what explains the residual of each joint that tells of itself, and what a mass would explain beside."""
    asked = windows.asked(nominal)
    names = nominal.robot.layout.actuated
    known = np.flatnonzero(known_joints(nominal, windows, asked, bounds)).tolist()
    if not known:
        return
    left = left_of(asked, windows.torque, nominal, bounds, range(len(names)))
    plain = np.square(quotient(size_of(windows.torque - asked.needed), size_of(windows.torque)))
    for k in known:
        explained = 1 - left[k] / plain[k]
        if plain[k] < bounds.floor or explained < HALF:
            continue
        most = np.asarray(bounds.offset * nominal.robot.torque_limits[k])
        numbers, offset = friction_fit(asked.terms[:, k], (windows.torque - asked.needed)[:, [k]], most)
        dry, viscous, rotor = numbers[:, 0] + 0.0  # no minus before zero
        yield (
            f"{names[k]}: friction of {dry:.3g} N m and {viscous:.3g} N m s/rad, rotor inertia of {rotor:.3g} kg m^2, "
            f"offset of {offset.item():.2g} N m explain {explained:.0%} of its square"
        )
    for mass in payloads(nominal, windows, asked, left, known):
        needed = asked.needed + mass.torque
        after = left_of(asked._replace(needed=needed), windows.torque, nominal, bounds, known)
        ratio = float(np.exp(np.log(np.maximum(after, 1e-9) / np.maximum(left[known], 1e-9)).mean()))
        if ratio < HALF and np.mean(after < left[known]) > HALF:
            yield f"{mass.text()}, would leave {ratio:.0%} of what is left: a tool, or masses of the table"

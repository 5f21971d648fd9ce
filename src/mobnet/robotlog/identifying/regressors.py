"""What each unknown of a joint contributes to the observer's residual, in windows of a log of free motion.

Nothing touches the robot, so its residual r is what the model gets wrong. With the law of `mobnet.estimation.drive` and
a rotor of the inertia I, -r is linear in what is unknown, behind the low-pass of (11), as (O11) of note 0034 says:

    -r = LP(coulomb s + load |tau| s + viscous v + offset + I dv/dt - (scale - 1) tau).

Both sides pass a second low-pass without delay, which keeps this equation and takes away the noise that differences of
the velocity have, and that would make the inertia too small (Gautier, "Dynamic identification of robots with power
model", ICRA 1997, filters in parallel for this reason).
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.signal import butter, sosfiltfilt

from mobnet.core.arrays import Array
from mobnet.core.recording import SensedRecording
from mobnet.estimation.drive import bent
from mobnet.estimation.low_pass import low_pass
from mobnet.estimation.observer import MomentumObserver
from mobnet.robot.description import RobotDescription
from mobnet.robot.nominal import NominalModel
from mobnet.settings.base import TorqueKind
from mobnet.settings.identification import Identification

OVERSAMPLED = 4.0  # samples of what is fitted, over the corner of the low-pass
ORDER = 2  # of that low-pass, which runs forwards and backwards
PLAIN = ("viscous", "offset", "armature", "scale")  # columns that have no smooth sign in them


@dataclass(frozen=True)
class Columns:
    """Names of the columns of a joint, target last, and the smooth signs that are tried.

    A sign is ("smoothing", width [rad/s]) or ("breakaway", angle [rad]); each has a column for the dry friction and one
    for the load.
    """

    signs: tuple[tuple[str, float], ...]

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the columns."""
        dry = tuple(f"{term}.{k}" for term in ("coulomb", "load") for k in range(len(self.signs)))
        return (*dry, *PLAIN, "target")


def columns_of(settings: Identification) -> Columns:
    """Return the columns that are tried."""
    smooth = [("smoothing", width) for width in settings.smoothing_rad_s]
    return Columns((*smooth, *(("breakaway", angle) for angle in settings.breakaway_rad)))


def bare(robot: RobotDescription) -> RobotDescription:
    """Return a robot without friction and rotors, so that what is found is all of it."""
    joints = tuple(joint.model_copy(update={"armature": 0.0}) for joint in robot.joints)
    return replace(robot, joints=joints, friction={})


def window_products(
    robot: RobotDescription, read: SensedRecording, torque: TorqueKind, gravity_m_s2: float, gain_hz: float,
    settings: Identification,
) -> Array:  # fmt: skip
    """Return mean products of the columns of each joint over each window of a recording, (windows, nu, m, m)."""
    nominal, nu = NominalModel(bare(robot), gravity_m_s2=gravity_m_s2), robot.layout.nu
    observer, columns = MomentumObserver(nominal, gain_hz, read.rate_hz, torque), columns_of(settings)
    width, found = len(columns.names), list[Array]()
    for span in read.spans():
        sensed = read.sensed[span]
        residual = observer.residual(sensed)[:, -nu:]
        v, tau = sensed.v[:, -nu:].astype(np.float64), sensed.tau_motor.astype(np.float64)
        joints = list[Array]()
        for j in range(nu):  # one after another: all columns of a humanoid's hour do not fit into the memory
            table = joint_columns(observer, v[:, j], tau[:, j], residual[:, j], columns)
            thin, rate_hz = thinned(table, read.rate_hz, settings.low_pass_hz)
            rows = round(settings.window_s * rate_hz)
            parts = thin[: len(thin) // rows * rows].reshape(-1, rows, width)
            joints.append(np.einsum("wta,wtb->wab", parts, parts) / rows)
        found.append(np.stack(joints, axis=1))
    return np.concatenate(found) if found else np.zeros((0, nu, width, width))


def joint_columns(observer: MomentumObserver, v: Array, tau: Array, residual: Array, columns: Columns) -> Array:
    """Return the columns of a joint, target last, (T, m), behind the low-pass of the observer.

    Its speed [rad/s], its motor's torque [N m] and its residual [N m] are those of one contiguous stretch, (T,).
    """
    rate_hz = observer.rate_hz
    signs = [_sign(kind, number, v, rate_hz) for kind, number in columns.signs]
    dry = [_means(sign) for sign in signs]
    loaded = [_means(np.abs(tau) * sign) for sign in signs]
    turned = np.diff(v, prepend=v[:1]) * rate_hz
    applied = tau if observer.torque == "mean" else _means(tau)
    raw = np.column_stack([*dry, *loaded, _means(v), np.ones_like(v), turned, -applied])
    return np.column_stack([low_pass(raw, observer.gain_hz, rate_hz), -residual])


def _sign(kind: str, number: float, v: Array, rate_hz: float) -> Array:
    """Return a smooth sign of a velocity (T,) [rad/s]."""
    if kind == "smoothing":
        return np.tanh(v / number)
    return bent(np.zeros(1), v[:, None], np.array([number]), rate_hz)[:, 0]


def _means(values: Array) -> Array:
    """Return means over the samples that end at the ticks (T,), of values at the ticks."""
    return np.concatenate([values[:1], (values[1:] + values[:-1]) / 2])


def thinned(table: Array, rate_hz: float, low_pass_hz: float) -> tuple[Array, float]:
    """Return columns (T, ...) behind a low-pass without delay, at fewer samples, and their rate [Hz]."""
    every = max(1, int(rate_hz / (OVERSAMPLED * low_pass_hz)))
    if len(table) < 2 * every or 2 * low_pass_hz >= rate_hz:
        return table, rate_hz
    sos = butter(ORDER, low_pass_hz, fs=rate_hz, output="sos")
    padding = min(len(table) - 1, round(rate_hz / low_pass_hz))
    return sosfiltfilt(sos, table, axis=0, padlen=padding)[::every], rate_hz / every


def moved(read: Sequence[SensedRecording], nu: int) -> Array:
    """Return the root mean square speed of each joint (nu,) [rad/s] in recordings."""
    squares = np.concatenate([np.square(one.sensed.v[:, -nu:].astype(np.float64)) for one in read])
    return np.sqrt(squares.mean(axis=0))

"""What each unknown of a robot contributes to the observer's raw residual, in windows of a log of free motion.

Nothing touches the robot, so that the residual s of (O1) in docs/notes/observer.md is what the model gets wrong. With
the law of
`mobnet.kernel.drive`, a rotor of the inertia I and links whose numbers differ by delta from those of the table,
-s is linear in what is unknown:

    -s = coulomb sign + load abs(tau) sign + viscous v + offset + I dv/dt - (scale - 1) tau + Y delta.

Y is the regressor of the links' dynamics (Swevers et al., "Dynamic model identification for industrial robots", IEEE
Control Systems 27(5), 2007). Both sides pass a low-pass without delay, which keeps the equation and takes away the
noise that differences of the velocity have, and that would make the inertia too small (Gautier, "Dynamic identification
of robots with power model", ICRA 1997, filters in parallel for this reason).
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import pinocchio as pin
from scipy.signal import butter, sosfiltfilt

from mobnet.core.arrays import Array
from mobnet.core.recording import Sensed, SensedRecording
from mobnet.estimation.observer import RobotObserver
from mobnet.kernel.drive import TorqueKind, bent
from mobnet.robot.description import RobotDescription
from mobnet.robot.nominal import NominalModel

OVERSAMPLED = 4.0  # samples of what is fitted, over the corner of the low-pass
ORDER = 2  # of that low-pass, which runs forwards and backwards
PLAIN = ("viscous", "offset", "armature", "scale")  # columns that have no smooth sign in them
LINK = ("mass", "x", "y", "z")  # directions of a link's error: share of mass and inertia, place of the centre of mass


@dataclass(frozen=True)
class WindowNumbers:
    """How a log becomes windows, and the smooth signs that are tried.

    Attributes:
        low_pass_hz: corner of the low-pass without delay behind which everything is fitted [Hz].
        window_s: length of the windows [s].
        smoothing_rad_s: widths of the smooth sign of which a joint takes the best [rad/s].
        breakaway_rad: angles of Dahl's law, the same [rad].
    """

    low_pass_hz: float
    window_s: float
    smoothing_rad_s: tuple[float, ...]
    breakaway_rad: tuple[float, ...]


@dataclass(frozen=True)
class Columns:
    """The smooth signs that are tried: ("smoothing", width [rad/s]) or ("breakaway", angle [rad]).

    Columns of a joint: the dry friction by each sign, the load by each sign, those of `PLAIN`, and the target.
    """

    signs: tuple[tuple[str, float], ...]

    def of(self, term: str, sign: int) -> int:
        """Return the place of a term's column, whose smooth sign is one of those that are tried."""
        count = len(self.signs)
        return {"coulomb": sign, "load": count + sign}[term] if term not in PLAIN else 2 * count + PLAIN.index(term)


@dataclass(frozen=True)
class RegressorWindows:
    """Windows of logs, laid one after another.

    Attributes:
        joints: columns of each joint, target last, (windows, rows, nu, m), SI units.
        links: what the errors of the links contribute to each joint, in units of `LINK`, (windows, rows, nu, d).
        payload: what the ten parameters of a payload contribute, (windows, rows, nu, 10), or none of them.
    """

    joints: Array
    links: Array
    payload: Array

    def __len__(self) -> int:
        """Return how many there are."""
        return len(self.joints)

    def __getitem__(self, part: slice) -> "RegressorWindows":
        """Return some of them."""
        return RegressorWindows(self.joints[part], self.links[part], self.payload[part])


def together(windows: Sequence[RegressorWindows]) -> RegressorWindows:
    """Return windows of several logs."""
    joints = np.concatenate([part.joints for part in windows])
    links = np.concatenate([part.links for part in windows])
    payload = np.concatenate([part.payload for part in windows])
    return RegressorWindows(joints, links, payload)


def columns_of(numbers: WindowNumbers) -> Columns:
    """Return the columns that are tried."""
    smooth = [("smoothing", width) for width in numbers.smoothing_rad_s]
    return Columns((*smooth, *(("breakaway", angle) for angle in numbers.breakaway_rad)))


def bare(robot: RobotDescription) -> RobotDescription:
    """Return a robot without friction and rotors, so that what is found is all of it."""
    joints = tuple(joint.model_copy(update={"armature": 0.0}) for joint in robot.joints)
    return replace(robot, joints=joints, friction={})


def windows_of(
    robot: RobotDescription,
    read: SensedRecording,
    torque: TorqueKind,
    gravity_m_s2: float,
    numbers: WindowNumbers,
    carrier: int | None = None,
) -> RegressorWindows:
    """Return the windows of a recording; the end of a segment behind its last whole window is not used.

    `carrier` is the joint whose body carries a payload that the table does not have.
    """
    nominal = NominalModel(bare(robot), gravity_m_s2=gravity_m_s2)
    # A gain this large has no low-pass: r is s of (O1).
    observer = RobotObserver(nominal, 1e3 * read.rate_hz, read.rate_hz, torque)
    columns = columns_of(numbers)
    every = max(1, int(read.rate_hz / (OVERSAMPLED * numbers.low_pass_hz)))
    rows = round(numbers.window_s * read.rate_hz / every)
    pieces = list[RegressorWindows]()
    for span in read.spans():
        sensed = read.sensed[span]
        if len(sensed) <= rows * every:
            continue
        parts = _Filter(numbers.low_pass_hz, read.rate_hz, every), rows
        regressor = _links(nominal, sensed, *parts)
        links = regressor @ link_directions(nominal.model, robot.layout.nu)
        payload = regressor[..., 10 * carrier : 10 * carrier + 10] if carrier is not None else regressor[..., :0]
        pieces.append(RegressorWindows(_joints(observer, sensed, columns, *parts), links, payload))
    if not pieces:
        nu = robot.layout.nu
        width = 2 * len(columns.signs) + len(PLAIN) + 1
        sizes = width, len(LINK) * nu, 0 if carrier is None else 10
        return RegressorWindows(*(np.zeros((0, rows, nu, size)) for size in sizes))
    return together(pieces)


class _Filter:
    """The low-pass without delay, after which fewer samples are kept."""

    def __init__(self, low_pass_hz: float, rate_hz: float, every: int) -> None:
        self.every = every
        self.rate_hz = rate_hz
        passes = 2 * low_pass_hz < rate_hz
        self._sos = butter(ORDER, low_pass_hz, fs=rate_hz, output="sos") if passes else None
        self._padding = round(rate_hz / low_pass_hz)

    def __call__(self, values: Array) -> Array:
        """Return signals (T, ...) behind it, all samples."""
        if self._sos is None:
            return values
        return sosfiltfilt(self._sos, values, axis=0, padlen=min(len(values) - 1, self._padding))


def _joints(observer: RobotObserver, sensed: Sensed, columns: Columns, thin: _Filter, rows: int) -> Array:
    """Return the columns of all joints in windows, target last, (windows, rows, nu, m)."""
    nu = observer.nominal.robot.layout.nu
    rate_hz = observer.rate_hz
    residual = observer.residual(sensed)[:, -nu:]
    v = sensed.v[:, -nu:].astype(np.float64)
    tau = sensed.tau_motor.astype(np.float64)
    columns_of_joints = list[Array]()
    for j in range(nu):  # one after another: all columns of a humanoid's hour do not fit into the memory
        signs = [_sign(kind, number, v[:, j], rate_hz) for kind, number in columns.signs]
        loaded = [np.abs(tau[:, j]) * sign for sign in signs]
        at_ticks = _means(np.column_stack([*signs, *loaded, v[:, j], np.ones(len(v))]))
        turned = np.diff(v[:, j], prepend=v[0, j]) * rate_hz
        applied = tau[:, j] if observer.torque == "mean" else _means(tau[:, j])
        table = np.column_stack([at_ticks, turned, -applied, -residual[:, j]])
        columns_of_joints.append(_cut(thin(table[1:])[:: thin.every], rows))
    return np.stack(columns_of_joints, axis=2)


def _links(nominal: NominalModel, sensed: Sensed, thin: _Filter, rows: int) -> Array:
    """Return what the parameters of all moving links contribute to the joints, (windows, rows, nu, 10 nu)."""
    nu = nominal.robot.layout.nu
    model = nominal.model
    data = nominal.data
    # Differences of a velocity with its noise would make the inertia too small: the low-pass comes first.
    velocity = thin(sensed.v.astype(np.float64))
    acceleration = np.gradient(velocity, axis=0) * thin.rate_hz
    keep = slice(1, None, thin.every)
    q = nominal.positions(sensed.q[keep])
    regressors = np.empty((len(q), nu, 10 * nu))
    for k, state in enumerate(zip(q, velocity[keep], acceleration[keep], strict=True)):
        regressors[k] = pin.computeJointTorqueRegressor(model, data, *state)[-nu:, -10 * nu :]
    return _cut(regressors, rows)


def link_directions(model: pin.Model, nu: int) -> Array:
    """Return how the ten parameters of each moving link change by its errors, (10 nu, d); Pinocchio's order."""
    directions = np.zeros((10 * nu, len(LINK) * nu))
    for k, inertia in enumerate(list(model.inertias)[-nu:]):
        rows = slice(10 * k, 10 * k + 10)
        first = len(LINK) * k
        directions[rows, first] = inertia.toDynamicParameters()
        for axis in range(3):
            directions[rows, first + 1 + axis] = _by_lever(inertia, np.eye(3)[axis])
    return directions


def _by_lever(inertia: pin.Inertia, along: Array) -> Array:
    """Return the derivative of a link's ten parameters by the place of its centre of mass along a unit vector."""
    ahead = inertia.copy()
    behind = inertia.copy()
    ahead.lever = inertia.lever + along / 2
    behind.lever = inertia.lever - along / 2
    return ahead.toDynamicParameters() - behind.toDynamicParameters()  # exact: they are quadratic in it


def _cut(values: Array, rows: int) -> Array:
    """Return whole windows of signals (T, ...), (windows, rows, ...)."""
    return values[: len(values) // rows * rows].reshape(-1, rows, *values.shape[1:])


def _sign(kind: str, number: float, v: Array, rate_hz: float) -> Array:
    """Return a smooth sign of a velocity (T,) [rad/s]."""
    if kind == "smoothing":
        return np.tanh(v / number)
    return bent(np.zeros(1), v[:, None], np.array([number]), rate_hz)[:, 0]


def _means(values: Array) -> Array:
    """Return means over the samples that end at the ticks (T, ...), of values at the ticks."""
    return np.concatenate([values[:1], (values[1:] + values[:-1]) / 2])


def moved(read: Sequence[SensedRecording], nu: int) -> Array:
    """Return the root mean square speed of each joint (nu,) [rad/s] in recordings."""
    squares = np.concatenate([np.square(recording.sensed.v[:, -nu:].astype(np.float64)) for recording in read])
    return np.sqrt(squares.mean(axis=0))

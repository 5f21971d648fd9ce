"""Inputs of the limb networks, eq. (17) and Table 1."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import chain
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import rotation
from mobnet.core.errors import ConfigError, not_accepted
from mobnet.core.joints import N_VIRTUAL, NQ_BASE, JointLayout
from mobnet.core.recording import Sensed
from mobnet.formats.network import Inertial, Limb
from mobnet.robot.frames import QUATERNION

OMEGA = slice(3, N_VIRTUAL)  # of the generalized velocity, base axes
ROTATION_NAMES: tuple[str, ...] = ("R.11", "R.21", "R.31", "R.12", "R.22", "R.32")
# Readings of the inertial sensor as columns of a recording, of which all but the rotation are read as they are.
IMU_NAMES: dict[Inertial, tuple[str, ...]] = {
    "rotation": ROTATION_NAMES,
    "angular_velocity": tuple(f"v.omega_{axis}" for axis in "xyz"),
    "acceleration": tuple(f"acc.{axis}" for axis in "xyz"),
}
BASE_NAMES = tuple(chain.from_iterable(IMU_NAMES.values()))
QUATERNION_NAMES = tuple(f"q.quat_{axis}" for axis in "wxyz")


@dataclass(frozen=True)
class LimbInputs:
    """Which signals one limb network sees, in the order of its row of Table 1.

    Attributes:
        names: name of each input, (n_in,): q^g [rad] and v^g [rad/s] of each limb in `Q`, tau_d^g [N m] of each limb
            in `T`, then of U^V where the base floats what `imu` names: two columns of the pelvis rotation, its angular
            velocity [rad/s] and its linear acceleration as the IMU reads it [m/s^2], both in pelvis axes.
        columns: where they stand in `signals`, (n_in,).
    """

    names: tuple[str, ...]
    columns: NDArray[np.intp]

    def __call__(self, sensed: Sensed) -> NDArray[np.float32]:
        """Return the inputs x^g of eq. (17), (T, n_in), or (n_in,) for one sample."""
        return signals(sensed)[..., self.columns]

    @property
    def recorded(self) -> tuple[str, ...]:
        """Columns of a recording that the inputs are made of: the quaternion, then those that are read as they are."""
        return (*self._turned, *(name for name in self.names if name not in ROTATION_NAMES))

    @property
    def _turned(self) -> tuple[str, ...]:
        """Columns of a recording that the rotation is made of; none of a robot whose base is fixed."""
        return QUATERNION_NAMES if set(ROTATION_NAMES) & set(self.names) else ()

    def from_recorded(self, values: NDArray[np.float32]) -> NDArray[np.float32]:
        """Return the inputs (T, n_in) from the columns `recorded`, the same as from a whole recording."""
        inputs = np.empty((len(values), len(self.names)), dtype=np.float32)
        width = len(self._turned)
        turned = np.isin(self.names, ROTATION_NAMES)
        if width:
            inputs[:, turned] = _first_columns(values[:, :width])
        inputs[:, ~turned] = values[:, width:]
        return inputs


def signals(sensed: Sensed) -> NDArray[np.float32]:
    """Return all that any limb network may see, in float32: the one place where physics turns into network numbers.

    Columns are those of `signal_names`, (T, 3 nu + 12), or (3 nu + 12,) for one sample, and 3 nu of them where the base
    is fixed; units as in `LimbInputs`.
    """
    if sensed.q.shape[-1] == sensed.v.shape[-1]:  # the orientation of a floating base has four numbers, its speed three
        return np.concatenate([sensed.q, sensed.v, sensed.tau_des], axis=-1, dtype=np.float32, casting="same_kind")
    # Where the robot stands and how fast it moves in the world are left out: no encoder or IMU tells them (4.2.1).
    parts = [
        sensed.q[..., NQ_BASE:],
        sensed.v[..., N_VIRTUAL:],
        sensed.tau_des,
        _first_columns(sensed.q[..., QUATERNION]),
        sensed.v[..., OMEGA],
        sensed.acc_base_in_base,
    ]
    return np.concatenate(parts, axis=-1, dtype=np.float32, casting="same_kind")


def _first_columns(quaternion: NDArray[Any]) -> NDArray[np.float64]:
    """Return the first two columns of the rotations (..., 6) of quaternions w x y z (..., 4)."""
    # The third column is the cross product of these two and would tell a network nothing new, (N1).
    columns = rotation(quaternion)[..., :2]
    return np.swapaxes(columns, -1, -2).reshape(*columns.shape[:-2], -1)


def signal_names(layout: JointLayout) -> tuple[str, ...]:
    """Return the names of the columns of `signals`, (3 nu + 12,), or (3 nu,) of a robot whose base is fixed."""
    base = BASE_NAMES if layout.virtual else ()
    return (*(f"{signal}.{j}" for signal in ("q", "v", "tau_des") for j in layout.actuated), *base)


def limb_inputs(layout: JointLayout, limb: Limb) -> LimbInputs:
    """Build the inputs of a network of Table 1 from its limbs `Q` and `T` and its `imu`; the width of x^g is (n_in,).

    Raises:
        ConfigError: a limb is unknown, or is the virtual one, which has no encoders or motors.
    """
    # (N1) in the order of Table 1, which is the order of a trained network's weights.
    names = list[str]()
    for joints in [_actuated(layout, name) for name in limb.Q]:
        names += [f"q.{joint}" for joint in joints]
        names += [f"v.{joint}" for joint in joints]
    for name in limb.T:
        names += [f"tau_des.{joint}" for joint in _actuated(layout, name)]
    if layout.virtual:
        names += chain.from_iterable(imu_names for reading, imu_names in IMU_NAMES.items() if reading in limb.imu)
    where = {name: i for i, name in enumerate(signal_names(layout))}
    return LimbInputs(tuple(names), np.array([where[name] for name in names], dtype=np.intp))


def _actuated(layout: JointLayout, limb: str) -> Sequence[str]:
    """Return the joints of a limb that has motors."""
    joints = layout.limb(limb)
    if set(joints) & set(layout.virtual):
        accepted = [name for name, group in layout.groups.items() if not set(group) & set(layout.virtual)]
        raise ConfigError(not_accepted("limb of a network's Q or T", limb, accepted))
    return joints

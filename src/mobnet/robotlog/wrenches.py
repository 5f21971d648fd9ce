"""The external wrench at a point of a limb, from the torques of its joints: `--wrench NAME` (docs/notes/contact.md).

Damped least squares: of the wrenches that explain the torques within their errors, the smallest. Where the joints feel
nothing of a direction, as near a singular pose, the damping gives zero in place of a huge number, the standard
deviation is that of not knowing it, and `told` says so.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from mobnet.core.columns import Column
from mobnet.core.estimator import Estimate
from mobnet.core.recording import Recording, SensedRecording
from mobnet.core.store import files_of, write_array
from mobnet.robot.nominal import NominalModel
from mobnet.robot.point_jacobian import point_jacobian
from mobnet.robot.word_checks import point_named

NAMES = ("force_x", "force_y", "force_z", "moment_x", "moment_y", "moment_z")
WRENCH_SIGNALS = {*NAMES, *(f"std_{name}" for name in NAMES), *(f"told_{name}" for name in NAMES)}
UNITS = ("N", "N", "N", "N m", "N m", "N m")
WRENCH = "wrench"  # array in the folder of a log
BLOCK_ROWS = 8192  # that are worked on at once


@dataclass(frozen=True)
class WrenchNumbers:
    """How an external wrench follows from torques of joints.

    Attributes:
        torque_error: error of an external torque without a standard deviation, as a share of its motor's largest one.
        force_n, moment_nm: a force and a moment that are large, beside which others are small [N], [N m].
        told: share of a component that comes from the torques, below which it counts as not told.
    """

    torque_error: float
    force_n: float
    moment_nm: float
    told: float


@dataclass(frozen=True)
class WrenchPoint:
    """A point of a body, at a place (3,) [m] in its frame, and the joints of its limb, of which so many move it."""

    name: str
    body: str
    pos: tuple[float, float, float]
    joints: tuple[str, ...]
    moved_by: int

    @property
    def parts(self) -> int:
        """How many numbers of a wrench are estimated: fewer than six joints cannot tell a moment from a force."""
        return len(NAMES) if self.moved_by >= len(NAMES) else len(NAMES) // 2


@dataclass(frozen=True)
class Wrenches:
    """Wrenches at a point in world axes: each is (T, 3) [N], or with moments (T, 6) [N], [N m].

    Attributes:
        mean: force, and moment about the point.
        std: standard deviations, where the torques have them.
        told: share of each number that comes from the torques [-]; the rest of it is taken as none.
    """

    place: WrenchPoint
    mean: NDArray[np.float32]
    std: NDArray[np.float32] | None
    told: NDArray[np.float32]


def place_of(nominal: NominalModel, name: str, joints: Sequence[str] | None = None) -> WrenchPoint:
    """Return the point of the robot's table, or the origin of the body, of a name.

    Joints are those of the limb that carries it; other ones may be given.

    Raises:
        ConfigError: there is no such point or body, or none of the joints moves it.
    """
    robot = nominal.robot
    body, pos, carrier = point_named(robot, name, joints)
    names = tuple(joints or robot.layout.limb(robot.layout.limb_of[carrier]))
    ahead = _joints_ahead(nominal, carrier)
    return WrenchPoint(name, body, pos, names, len([joint for joint in names if joint in ahead]))


def _joints_ahead(nominal: NominalModel, joint: str) -> list[str]:
    """Return a joint and those that carry it."""
    joints = nominal.robot.layout.actuated
    link = 1 + nominal.robot.layout.actuated.index(joint)
    ahead = []
    while link > 0:
        ahead.append(joints[link - 1])
        link = int(nominal.linkage.links[link]["parent"])
    return ahead


def wrenches_of(
    nominal: NominalModel, place: WrenchPoint, q: NDArray[np.floating], torque: Estimate, numbers: WrenchNumbers
) -> Wrenches:
    """Return the wrenches that explain external torques of the place's joints (T, n) [N m] at positions (T, nq).

    Errors of joints are taken as independent, with the standard deviations of the torques, or, where they have none,
    with a share of the largest torque of each.
    """
    columns = [nominal.robot.layout.actuated.index(joint) for joint in place.joints]
    usual = numbers.torque_error * nominal.robot.torque_limits[columns]
    large = np.repeat([numbers.force_n, numbers.moment_nm], 3)[: place.parts]
    shape = (len(q), place.parts)
    mean, std, told_share = (np.empty(shape, dtype=np.float32) for _ in range(3))
    for start in range(0, len(q), BLOCK_ROWS):
        rows = slice(start, start + BLOCK_ROWS)
        error = usual if torque.std is None else torque.std[rows].astype(np.float64)
        jacobian = point_jacobian(nominal, place.body, place.pos, q[rows])[:, : place.parts, columns]
        # In units of the large wrench, and torques in those of their errors
        units = large[:, None] * jacobian / np.broadcast_to(error, (len(jacobian), len(columns)))[:, None, :]
        # The unit matrix is the damping: near a singular pose least squares alone would make huge numbers of errors.
        covariance = np.linalg.inv(units @ np.swapaxes(units, 1, 2) + np.eye(place.parts))
        seen = units @ (torque.tau_ext[rows] / error)[..., None]
        mean[rows] = large * (covariance @ seen)[..., 0]
        variance = np.diagonal(covariance, axis1=1, axis2=2)
        std[rows] = large * np.sqrt(variance)
        told_share[rows] = np.clip(1.0 - variance, 0.0, 1.0)
    return Wrenches(place, mean, None if torque.std is None else std, told_share)


def wrench_table(wrenches: Sequence[Wrenches]) -> tuple[NDArray[np.float32], list[Column]]:
    """Return the array (T, n) and the columns of wrenches at several points."""
    arrays: list[NDArray[np.float32]] = []
    columns: list[Column] = []
    for at_place in wrenches:
        components = list(zip(NAMES, UNITS, strict=True))[: at_place.place.parts]
        arrays.append(at_place.mean)
        columns += [(f"{name}.{at_place.place.name}", unit, "world") for name, unit in components]
        if at_place.std is not None:
            arrays.append(at_place.std)
            columns += [(f"std_{name}.{at_place.place.name}", unit, "world") for name, unit in components]
        arrays.append(at_place.told)
        columns += [(f"told_{name}.{at_place.place.name}", "-", "world") for name, _ in components]
    return np.concatenate(arrays, axis=1), columns


def wrench_columns(places: Iterable[str]) -> list[str]:
    """Return the columns that an array of wrenches at some points has at least."""
    forces = NAMES[:3]
    columns = list[str]()
    for place in sorted(places):
        columns += [f"{name}.{place}" for name in forces]
        columns += [f"told_{name}.{place}" for name in forces]
    return columns


def write_wrenches(
    wrenches: Sequence[Wrenches], recording: SensedRecording | Recording, method: str, out: Path
) -> None:
    """Write the wrenches of a recording by a method into a folder; where there are none, those of before go."""
    for file in files_of(out / WRENCH):
        file.unlink(missing_ok=True)
    if wrenches:
        array, columns = wrench_table(wrenches)
        write_array(out / WRENCH, array, columns, {"rate_hz": recording.rate_hz, "method": method}, recording.segments)


def wrench_lines(wrenches: Sequence[Wrenches], numbers: WrenchNumbers, out: Path) -> Iterator[str]:
    """Yield what is printed of wrenches: their sizes, where the joints do not tell them, and the file."""
    for at_place in wrenches:
        force, *moment = (_size(part) for part in np.split(at_place.mean, at_place.place.parts // 3, axis=1))
        beside = "".join(f" and moment of {size:.3g} N m" for size in moment)
        yield f"wrench at {at_place.place.name}, world axes: force of {force:.3g} N{beside}, root mean square"
        if not moment:
            count = at_place.place.moved_by
            moving = "1 joint of the limb moves" if count == 1 else f"{count} joints of the limb move"
            yield f"  {moving} it: a moment there is taken as none"
        unsure = np.asarray(at_place.told < numbers.told)
        never = np.atleast_1d(unsure.all(axis=0))
        if never.any():
            names = ", ".join(name for name, is_so in zip(NAMES, never, strict=False) if is_so)
            yield f"  the joints never tell {names}: what is written of it is as good as nothing"
        if singular := float(unsure[:, ~never].any(axis=1).mean()):
            yield f"  near a singular pose in {singular:.2%} of the samples: see the columns told_..."
    if wrenches:
        yield f"written: {out / WRENCH}.parquet"


def _size(vectors: NDArray[np.float32]) -> float:
    """Return the root mean square length of vectors (T, 3)."""
    return float(np.sqrt(np.square(vectors, dtype=np.float64).sum(axis=1).mean()))

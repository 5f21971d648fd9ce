"""A model of Pinocchio taken apart into simple joints, of which p and beta of the observer are what section 3.2 says.

Where the axes of a joint move in its own link (composites, universal joints, Euler angles), Pinocchio's Coriolis matrix
is not that of C + C^T = Mdot, and the velocity of a free-flyer is in axes that turn. So a composite becomes the chain
of its parts, and a free-flyer a translation along axes that are fixed in its parent, and then a ball. A mimic joint
becomes one of its own, whose torque counts at the joint that it follows. Positions and velocities are the same numbers
in both models, but for

    a free-flyer     linear velocity in its own axes    becomes    that in its parent's
    an endless hinge       cosine and sine              becomes    its angle
    a mimic joint               nothing                 becomes    scale and offset of the joint that it follows
"""

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from mobnet.core.arrays import Array, rotation, rows_of
from mobnet.core.errors import ConfigError, not_accepted
from mobnet.kernel.linkage import linkage_of
from mobnet.kernel.momentum import sweep

HINGES = ("JointModelRX", "JointModelRY", "JointModelRZ", "JointModelRevoluteUnaligned")
FLOATING = ["JointModelTranslation", "JointModelSpherical"]  # the joints of a base, as compiled code takes them
# Joints whose axes are fixed in their own link.
SIMPLE = (
    *HINGES,
    *FLOATING,
    "JointModelPX",
    "JointModelPY",
    "JointModelPZ",
    "JointModelPrismaticUnaligned",
    "JointModelHX",
    "JointModelHY",
    "JointModelHZ",
    "JointModelHelicalUnaligned",
    "JointModelPlanar",
)
ENDLESS = {
    "JointModelRUBX": pin.JointModelRX,
    "JointModelRUBY": pin.JointModelRY,
    "JointModelRUBZ": pin.JointModelRZ,
}
HERE = pin.SE3.Identity()
SMALL = 1e-3  # angle [rad] or way [m] over which the axis of a mimic joint is found


class SimpleJoint(NamedTuple):
    """A simple joint of a joint.

    Attributes:
        joint: its model.
        placement: where it is in the link of the part before it.
        kind: `same`, or `linear` of a free-flyer, or `endless`.
    """

    joint: pin.JointModel
    placement: pin.SE3
    kind: str = "same"


class JointColumns(NamedTuple):
    """The first position and the first velocity of a joint, in the given model and among simple joints."""

    q: int
    v: int
    simple_q: int
    simple_v: int


class Mimic(NamedTuple):
    """A joint that follows another one: the columns of that and its own, scale [-] or [m], offset [rad] or [m]."""

    columns: JointColumns
    scale: float
    offset: float


class Mechanism:
    """A model of Pinocchio as the observer takes it.

    Attributes:
        model: the given model.
        simple: the model of simple joints.
        is_compiled: whether all joints are hinges, on a base that is fixed or floats: then compiled code computes.
        linkage: the constants of the simple model for compiled code; None where Pinocchio computes.
        is_same: whether positions and velocities of both models are the same numbers.
    """

    def __init__(self, model: pin.Model) -> None:
        """Take a model apart.

        Raises:
            ConfigError: it has nothing that moves, or a joint that cannot be taken apart.
        """
        if model.nv == 0:
            raise ConfigError(not_accepted(f"model {model.name!r}: velocities", model.nv, ["at least 1"]))
        self.model = model
        self.simple = pin.Model()
        self.simple.name = model.name
        self.simple.gravity = model.gravity
        self._same_q: dict[int, int] = {}  # columns of positions: given -> simple
        self._same_v: dict[int, int] = {}
        self._linear: list[JointColumns] = []
        self._endless: list[JointColumns] = []
        self._mimics: list[Mimic] = []
        self._take_apart()
        self._data = self.simple.createData()
        self._floats = self._has_floating_base()
        self.is_compiled = self._is_of_hinges()
        turns_quaternion = self.is_compiled and self._floats
        self.is_same = not (self._linear or self._endless or self._mimics or turns_quaternion)
        self.linkage = linkage_of(self.simple) if self.is_compiled else None

    @property
    def widths(self) -> tuple[int, ...]:
        """How many numbers a position may have: nq, or one less for each endless hinge, whose angle is then given."""
        return tuple(dict.fromkeys((self.model.nq, self.model.nq - len(self._endless))))

    def with_circles(self, q: Array) -> Array:
        """Return positions (T, nq) with cosine and sine of each endless hinge, where its angle is given."""
        if q.shape[1] == self.model.nq:
            return q
        whole = np.empty((len(q), self.model.nq))
        cosines = [at.q for at in self._endless]
        sines = [at.q + 1 for at in self._endless]
        rest = [column for column in range(self.model.nq) if column not in sines]
        whole[:, rest] = q
        whole[:, sines] = np.sin(whole[:, cosines])
        whole[:, cosines] = np.cos(whole[:, cosines])
        return whole

    def columns_of(self, joint: str) -> list[int]:
        """Return the columns of a joint's velocities among simple joints.

        Raises:
            ConfigError: the model has no such joint, or it only follows another one.
        """
        names = [self.model.names[k] for k in range(1, self.model.njoints) if self.model.joints[k].nv]
        if joint not in names:
            raise ConfigError(not_accepted("joint", joint, names))
        number = self.model.getJointId(joint)
        first = self.model.idx_vs[number]
        return [self._same_v[column] for column in range(first, first + self.model.nvs[number])]

    def terms(self, q: NDArray[Any], v: NDArray[Any]) -> tuple[Array, Array]:
        """Return p of (4) and beta of (6) at simple joints (..., nv) [kg m/s], [kg m^2/s] and [N], [N m].

        Positions (..., nq) and velocities (..., nv) are those of `to_simple`.
        """
        samples = np.shape(v)[:-1]
        positions = rows_of("q", q, samples, self.simple.nq)
        velocities = rows_of("v", v, samples, self.simple.nv)
        p = np.empty_like(velocities)
        beta = np.empty_like(velocities)
        if self.linkage is not None:
            sweep(self.linkage, positions, velocities, p, beta)
        else:
            for k in range(len(p)):
                p[k], beta[k] = self._of_pinocchio(positions[k], velocities[k])
        return p.reshape(np.shape(v)), beta.reshape(np.shape(v))

    def to_simple(self, q: NDArray[Any], v: NDArray[Any]) -> tuple[Array, Array]:
        """Return positions (T, nq) and velocities (T, nv) of the given model as those of simple joints."""
        if self.is_same:
            return q, v
        positions = np.zeros((len(q), self.simple.nq))
        velocities = np.zeros((len(q), self.simple.nv))
        positions[:, list(self._same_q.values())] = q[:, list(self._same_q)]
        velocities[:, list(self._same_v.values())] = v[:, list(self._same_v)]
        for at in self._endless:
            positions[:, at.simple_q] = _angle(q, at)
        for at in self._linear:
            turned = _rotations(q[:, at.q + 3 : at.q + 7])
            linear = v[:, at.v : at.v + 3, None]
            velocities[:, at.simple_v : at.simple_v + 3] = (turned @ linear)[..., 0]
        for at, scale, offset in self._mimics:
            is_endless = at.q in [hinge.q for hinge in self._endless]
            followed = _angle(q, at) if is_endless else q[:, at.q]
            positions[:, at.simple_q] = scale * followed + offset
            velocities[:, at.simple_v] = scale * v[:, at.v]
        if self.is_compiled and self._floats:
            positions[:, 3:7] = positions[:, [6, 3, 4, 5]]  # compiled code takes w x y z
        return positions, velocities

    def from_simple(self, q: NDArray[Any], torque: Array) -> Array:
        """Return torques at simple joints (T, n) [N], [N m] as those of the model (T, nv) at its positions (T, nq)."""
        if self.is_same:
            return torque
        given = np.zeros((len(q), self.model.nv))
        given[:, list(self._same_v)] = torque[:, list(self._same_v.values())]
        for at in self._linear:
            turned = _rotations(q[:, at.q + 3 : at.q + 7])
            force = torque[:, at.simple_v : at.simple_v + 3, None]
            given[:, at.v : at.v + 3] = (turned.transpose(0, 2, 1) @ force)[..., 0]
        for at, scale, _ in self._mimics:
            given[:, at.v] += scale * torque[:, at.simple_v]
        return given

    def _of_pinocchio(self, q: Array, v: Array) -> tuple[Array, Array]:
        """Return p and beta of one sample."""
        upper = np.triu(pin.crba(self.simple, self._data, q))  # with the rotors
        mass = upper + np.triu(upper, 1).T
        coriolis = pin.computeCoriolisMatrix(self.simple, self._data, q, v)
        weight = pin.computeGeneralizedGravity(self.simple, self._data, q)
        return mass @ v, coriolis.T @ v - weight

    def _take_apart(self) -> None:
        """Add the parts of all joints with the links and rotors, and note which columns are which."""
        carriers = [0]  # of each joint, the simple joint that carries its link
        rotors: dict[int, float] = {}
        self.simple.appendBodyToJoint(0, self.model.inertias[0], HERE)
        for number in range(1, self.model.njoints):
            joint = self.model.joints[number]
            carrier = carriers[self.model.parents[number]]
            placement = self.model.jointPlacements[number]
            q = joint.idx_q
            v = joint.idx_v
            for count, part in enumerate(_parts_of(self.model, number)):
                name = f"{self.model.names[number]}/{count}"
                carrier = self.simple.addJoint(carrier, part.joint, placement * part.placement, name)
                placement = HERE
                added = self.simple.joints[carrier]
                self._note(part, JointColumns(q, v, added.idx_q, added.idx_v), added, joint)
                rotors |= {added.idx_v + k: float(self.model.armature[v + k]) for k in range(added.nv) if joint.nv}
                q += 2 if part.kind == "endless" else added.nq
                v += added.nv
            self.simple.appendBodyToJoint(carrier, self.model.inertias[number], HERE)
            carriers.append(carrier)
        armature = np.zeros(self.simple.nv)
        armature[list(rotors)] = list(rotors.values())
        self.simple.armature = armature

    def _note(self, part: SimpleJoint, at: JointColumns, added: pin.JointModel, joint: pin.JointModel) -> None:
        """Note the columns of a part that was added."""
        if part.kind == "mimic":
            given = joint.extract()
            self._mimics.append(Mimic(at, given.scaling, given.offset))
            return
        if part.kind == "endless":
            self._endless.append(at)
        else:
            self._same_q |= {at.q + k: at.simple_q + k for k in range(added.nq)}
        if part.kind == "linear":
            self._linear.append(at)
        else:
            self._same_v |= {at.v + k: at.simple_v + k for k in range(added.nv)}

    def _has_floating_base(self) -> bool:
        """Return whether a translation and a ball at the world's origin carry all links."""
        kinds = [self.simple.joints[k].shortname() for k in range(1, min(3, self.simple.njoints))]
        others = list(self.simple.parents)[3:]
        at_origin = self.simple.jointPlacements[1].isIdentity()
        return kinds == FLOATING and at_origin and self.simple.parents[2] == 1 and 0 not in others and 1 not in others

    def _is_of_hinges(self) -> bool:
        """Return whether compiled code can take the simple joints."""
        first = 3 if self._floats else 1
        return all(self.simple.joints[k].shortname() in HINGES for k in range(first, self.simple.njoints))


def _parts_of(model: pin.Model, number: int) -> Iterator[SimpleJoint]:
    """Yield the simple joints of a joint of a model, from its parent outwards.

    Raises:
        ConfigError: it cannot be taken apart.
    """
    joint = model.joints[number]
    if joint.shortname() == "JointModelMimic":
        scale = joint.extract().scaling
        if scale == 0.0:
            raise ConfigError(not_accepted(f"joint {model.names[number]!r}: scale", scale, ["other than 0"]))
        yield SimpleJoint(_turning_or_sliding(model, number, scale), HERE, "mimic")
    else:
        yield from _simple(joint, model.names[number])


def _simple(joint: pin.JointModel, name: str) -> Iterator[SimpleJoint]:
    """Yield the simple joints of a joint that follows no other one.

    Raises:
        ConfigError: it is of a kind that cannot be taken apart.
    """
    kind = joint.shortname()
    model = joint.extract() if hasattr(joint, "extract") else joint
    if kind in SIMPLE:
        yield SimpleJoint(model, HERE)
    elif kind in ENDLESS:
        yield SimpleJoint(ENDLESS[kind](), HERE, "endless")
    elif kind == "JointModelRevoluteUnboundedUnaligned":
        alone = pin.Model()
        alone.addJoint(0, joint, HERE, name)
        yield SimpleJoint(_turning_or_sliding(alone, 1, 1.0), HERE, "endless")
    elif kind == "JointModelFreeFlyer":
        yield SimpleJoint(pin.JointModelTranslation(), HERE, "linear")
        yield SimpleJoint(pin.JointModelSpherical(), HERE)
    elif kind == "JointModelUniversal":
        yield SimpleJoint(pin.JointModelRevoluteUnaligned(model.axis1), HERE)
        yield SimpleJoint(pin.JointModelRevoluteUnaligned(model.axis2), HERE)
    elif kind == "JointModelSphericalZYX":
        yield SimpleJoint(pin.JointModelRZ(), HERE)
        yield SimpleJoint(pin.JointModelRY(), HERE)
        yield SimpleJoint(pin.JointModelRX(), HERE)
    elif kind == "JointModelComposite":
        for inner, placement in zip(model.joints, model.jointPlacements, strict=True):
            for part in _simple(inner, name):
                yield SimpleJoint(part.joint, placement * part.placement, part.kind)
                placement = HERE
    else:
        raise ConfigError(not_accepted(f"joint {name!r}: kind", kind, [*SIMPLE, *ENDLESS, "chains of them"]))


def _turning_or_sliding(model: pin.Model, number: int, scale: float) -> pin.JointModel:
    """Return a hinge or a slider that moves as a joint of one velocity does, over a scale.

    Pinocchio does not tell Python the axis of a mimic joint nor that of an endless hinge, but moves them.
    """
    data = model.createData()
    start = pin.neutral(model)
    pin.forwardKinematics(model, data, start)
    before = data.liMi[number].copy()
    velocity = np.zeros(model.nv)
    velocity[model.joints[number].idx_v] = SMALL
    pin.forwardKinematics(model, data, pin.integrate(model, start, velocity))
    way = pin.log6(before.actInv(data.liMi[number])).vector / (SMALL * scale)
    turning = float(np.linalg.norm(way[3:]))
    if turning > 0.5:
        return pin.JointModelRevoluteUnaligned(way[3:] / turning)
    return pin.JointModelPrismaticUnaligned(way[:3] / np.linalg.norm(way[:3]))


def _angle(q: NDArray[Any], at: JointColumns) -> Array:
    """Return the angle of an endless hinge (T,) [rad] of its cosine and sine."""
    return np.arctan2(q[:, at.q + 1], q[:, at.q])


def _rotations(quaternions: NDArray[Any]) -> Array:
    """Return the rotations (T, 3, 3) of quaternions x y z w (T, 4), which logs round and which are made unit length."""
    return rotation(np.roll(quaternions, 1, axis=1) / np.linalg.norm(quaternions, axis=1, keepdims=True))

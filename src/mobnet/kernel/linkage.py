"""A robot's kinematic tree as compiled code takes it, one record for each link, parents first; rotations of its links.

Rotations are lanes of arrays (3, 3, lanes), from a link's axes to its parent's.
"""

from typing import Any, NamedTuple

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.core.machine_code import compiled
from mobnet.kernel.triples import put

ROOT_JOINTS = 2  # of a floating base in Pinocchio: translation and ball
LINK = np.dtype(
    [
        ("parent", np.int64),  # its record
        ("still", np.float64, (3, 3)),  # the rotation from link to parent is still + cos(q) cosine + sin(q) sine
        ("cosine", np.float64, (3, 3)),
        ("sine", np.float64, (3, 3)),
        ("offset", np.float64, 3),  # origin in the parent's axes [m]
        ("axis", np.float64, 3),  # of the hinge, unit vector
        ("mass", np.float64),  # [kg]
        ("moment", np.float64, 3),  # mass times centre of mass [kg m]
        ("inertia", np.float64, (3, 3)),  # about the origin [kg m^2]
        ("behind", np.float64),  # mass of the link and of all links that it carries [kg]
        ("armature", np.float64),  # inertia of the rotor at the joint [kg m^2]
    ]
)


class Linkage(NamedTuple):
    """Links and gravity.

    Attributes:
        links: the base and then the link of each hinge, in the order of the joints, (1 + nu,) of `LINK`.
        gravity: in world axes (3,) [m/s^2].
    """

    links: NDArray[np.void]
    gravity: Array


def linkage_of(model: pin.Model) -> Linkage:
    """Return the constants of a model of hinges on a base that is fixed, or floats as `NominalModel` has it."""
    root = ROOT_JOINTS if model.nv >= model.njoints else 0  # the joint of the base: its six velocities are of two
    links = np.zeros(model.njoints - root, LINK)
    data = model.createData()
    pin.computeJointJacobians(model, data, pin.neutral(model))
    for link, body in zip(links, model.inertias[root:], strict=True):
        lever = pin.skew(body.lever)
        link["mass"] = body.mass
        link["moment"] = body.mass * body.lever
        link["inertia"] = body.inertia - body.mass * lever @ lever
    for joint, link in enumerate(links[1:], root + 1):
        _place(model, data, joint, link)
        link["parent"] = model.parents[joint] - root
    links["behind"] = links["mass"]
    for link in links[:0:-1]:
        links["behind"][link["parent"]] += link["behind"]
    return Linkage(links, np.array(model.gravity.linear))


def _place(model: pin.Model, data: pin.Data, joint: int, link: Any) -> None:
    """Set the hinge of a link: where it is in its parent, its axis and its rotor."""
    placement = model.jointPlacements[joint]
    column = model.idx_vs[joint]
    # of a model with one velocity it is a vector
    whole = np.reshape(pin.getJointJacobian(model, data, joint, pin.ReferenceFrame.LOCAL), (-1, model.nv))
    axis = whole[3:, column]
    along = np.outer(axis, axis)
    # Rodrigues' formula, behind the rotation of the joint's frame in its parent's
    link["still"] = placement.rotation @ along
    link["cosine"] = placement.rotation @ (np.eye(3) - along)
    link["sine"] = placement.rotation @ pin.skew(axis)
    link["axis"], link["offset"], link["armature"] = axis, placement.translation, model.armature[column]


@compiled
def turn(link: Any, cosine: float, sine: float, rotation: Array, lane: int) -> None:
    """Set the rotation of a link whose hinge is at an angle of that cosine and sine."""
    for i in range(3):
        for j in range(3):
            rotation[i, j, lane] = link.still[i, j] + (cosine * link.cosine[i, j] + sine * link.sine[i, j])


@compiled
def turn_base(q: Array, rotation: Array, lane: int) -> None:
    """Set the rotation of a floating base to the world from a position (nq,), whose quaternion is of any length."""
    w = q[3]
    x = q[4]
    y = q[5]
    z = q[6]
    s = 2.0 / (w * w + x * x + y * y + z * z)
    put(rotation[0], lane, (1.0 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y)))
    put(rotation[1], lane, (s * (x * y + w * z), 1.0 - s * (x * x + z * z), s * (y * z - w * x)))
    put(rotation[2], lane, (s * (x * z - w * y), s * (y * z + w * x), 1.0 - s * (x * x + y * y)))

"""What must hold between the rows of a robot's table: a tree, motors in order, figures that fit each other."""

from collections.abc import Iterator, Mapping, Sequence
from itertools import chain, zip_longest
from math import dist
from typing import TypeVar

import numpy as np

from mobnet.core.errors import misfit, not_accepted
from mobnet.core.joints import LEG_AXES, N_VIRTUAL, right_of, with_image
from mobnet.formats.faults import as_many, within
from mobnet.formats.names import unknown, uses
from mobnet.formats.parts import GYRATION_M, PointRow, ShapeRow
from mobnet.formats.reading import Place, Problem
from mobnet.formats.robot import WORLD, RobotTable

MASS_TOLERANCE = 1e-6  # relative, of the total
LENGTH_TOLERANCE_M = 1e-6
Row = TypeVar("Row", bound=PointRow)


def robot_problems(table: RobotTable) -> Iterator[Problem]:
    """Yield the place and the text of everything that does not fit together."""
    names = [*unknown(uses(table, RobotTable), table.accepted_names), *_repeated(table), *_tree_problems(table)]
    names += _base_problems(table)
    yield from names
    if not names:  # only then can what they name be looked up
        for check in (_order_problems, _limb_problems, _foot_problems, _size_problems, _total_problems):
            yield from check(table)


def joints_above(table: RobotTable, body: str) -> list[str]:
    """Return the ids of the joints that move a body, from the base on."""
    parents = {row.name: row.parent for row in table.bodies}
    moved = {row.body: row.id for row in table.joints}
    joints = list[str]()
    while body in parents:
        joints += [moved[body]] if body in moved else []
        body = parents[body]
    return joints[::-1]


def shapes_of_looks(table: RobotTable) -> Sequence[ShapeRow]:
    """Return the solids of a robot's looks; none where it has none."""
    return table.looks.shapes if table.looks else ()


def _repeated(table: RobotTable) -> Iterator[Problem]:
    """Yield names that occur twice where each may occur once."""
    lists: dict[Place, list[str]] = {
        ("bodies",): [body.name for body in table.bodies],
        ("joints",): [*(joint.body for joint in table.joints), *(f"id {joint.id}" for joint in table.joints)],
        ("order",): [*table.order.virtual, *table.order.actuated],
        ("groups",): list(chain.from_iterable(table.groups.values())),
        ("shapes",): _with_images(table.shapes),
        ("points",): _with_images(table.points),
        ("looks", "shapes"): _with_images(shapes_of_looks(table)),
    }
    for kind, given_lists in (("groups", table.groups), ("networks", table.networks)):
        lists[kind,] = [*lists.get((kind,), []), *(name.casefold() for name in given_lists)]  # names of files
    for place, names in lists.items():
        for name in sorted({name for name in names if names.count(name) > 1}):
            yield place, f"{name!r} {names.count(name)} times is not accepted; accepted: each name once"


def _with_images(rows: Sequence[PointRow]) -> list[str]:
    """Return the names of rows and of their mirror images."""
    return list(chain.from_iterable(with_image(row.name) for row in rows))


def _numbered(rows: Mapping[Place, Sequence[Row]]) -> Iterator[tuple[Place, int, Row]]:
    """Yield the rows of several lists, each with the place of its list and its number there."""
    for place, of_list in rows.items():
        for index, row in enumerate(of_list):
            yield place, index, row


def _tree_problems(table: RobotTable) -> Iterator[Problem]:
    """Yield bodies that do not stand right below the branch that they hang on, and mirror images without a body."""
    branch = [WORLD]
    for index, body in enumerate(table.bodies):
        if body.parent not in branch:
            yield ("bodies", index, "parent"), not_accepted(f"parent of {body.name}", body.parent, branch)
        else:
            branch = branch[: branch.index(body.parent) + 1]
        branch = [name for name in branch if name != WORLD] + [body.name]
    names = {body.name for body in table.bodies}
    mirrored: Mapping[Place, Sequence[PointRow]] = {
        ("shapes",): table.shapes,
        ("points",): table.points,
        ("looks", "shapes"): shapes_of_looks(table),
    }
    for place, index, row in _numbered(mirrored):
        if len(with_image(row.name)) > 1 and row.body in names and right_of(row.body) not in names:
            yield (*place, index, "body"), not_accepted("body of the mirror image", right_of(row.body), names)


def _order_problems(table: RobotTable) -> Iterator[Problem]:
    """Yield where joints, the bodies that they move, or the joints of a limb first depart from the order of motors."""
    moved = {joint.body: joint.id for joint in table.joints}
    lists = {
        "joints": [joint.id for joint in table.joints],
        "bodies": [moved[body.name] for body in table.bodies if body.name in moved],
    }
    for kind, names in lists.items():
        for index, (name, accepted) in enumerate(zip_longest(names, table.order.actuated)):
            if name != accepted:
                yield (kind,), f"joint {index}, {name!r}, is not accepted; accepted: {accepted!r}, by `order.actuated`"
                break
    order = [*table.order.virtual, *table.order.actuated]
    for limb, joints in table.groups.items():
        if sorted(joints, key=order.index) != list(joints):
            yield ("groups", limb), f"{list(joints)} is not accepted; accepted: joints in the order of `order`"
    for name in set(order).difference(*table.groups.values()):
        yield ("groups",), f"no limb with {name} is not accepted; accepted: every joint in a limb"


def _limb_problems(table: RobotTable) -> Iterator[Problem]:
    """Yield postures that do not fit their limb, and networks that see motion or torques of the base."""
    ranges = {joint.id: joint.range for joint in table.joints}
    for limb, posture in table.posture.items():
        joints = table.groups[limb]
        for name, values in posture:
            yield from as_many(("posture", limb, name), len(values), len(joints), "one for each joint")
        for index, (joint, angle) in enumerate(zip(joints, posture.angle_rad, strict=False)):
            place = ("posture", limb, "angle_rad", index)
            ends = ranges.get(joint, (-np.inf, np.inf))
            yield from within(place, angle, ends, f"the range of {joint}")
    moving = [limb for limb, joints in table.groups.items() if not set(joints) & set(table.order.virtual)]
    for name, network in table.networks.items():
        for key, limbs in (("Q", network.Q), ("T", network.T)):
            for index, limb in enumerate(limbs):
                if limb not in moving:
                    yield ("networks", name, key, index), not_accepted("limb with motors", limb, moving)


def _base_problems(table: RobotTable) -> Iterator[Problem]:
    """Yield virtual joints, a sensor or a hinge that do not fit the base."""
    base = table.bodies[0].name
    wanted = N_VIRTUAL if table.base == "floating" else 0
    if len(table.order.virtual) != wanted:
        text = f"{len(table.order.virtual)} joints are not accepted; accepted: {wanted} of a {table.base} base"
        yield ("order", "virtual"), text
    if table.imu is not None and table.imu.body != base:
        yield ("imu", "body"), not_accepted("body", table.imu.body, [base])
    for index, joint in enumerate(table.joints):
        if joint.body == base:
            yield ("joints", index, "body"), f"the base {base!r} is not accepted; accepted: a body below it"


def _foot_problems(table: RobotTable) -> Iterator[Problem]:
    """Yield feet, soles, legs and hands that do not fit the tree of bodies."""
    if bool(table.feet) != (table.sole is not None):
        yield ("feet",), "`feet` without `sole`, or one without the other, is not accepted; accepted: both or none"
    for side, foot in table.feet.items():
        if joints_above(table, foot.body) != list(table.groups[foot.limb]):
            text = f"{foot.body} is not accepted; accepted: the body at the end of limb {foot.limb}"
            yield ("feet", side, "body"), text
    sides = [(("feet",), {side: foot.body for side, foot in table.feet.items()}), (("hands",), dict(table.hands))]
    limbs = dict[str, str]()  # joint -> limb
    for limb, joints in table.groups.items():
        limbs |= dict.fromkeys(joints, limb)
    for side, body in table.hands.items():
        limbs_above = {limbs[joint] for joint in joints_above(table, body)[-1:] if joint in limbs}
        if limbs_above and not any(limb.casefold().startswith(side[0]) for limb in limbs_above):
            yield ("hands", side), misfit(body, f"a body at the end of a limb of the {side} side")
    for place, bodies in sides:
        if len(bodies) == 2 and right_of(bodies["left"]) != bodies["right"]:
            yield (*place, "right"), not_accepted("body", bodies["right"], [right_of(bodies["left"])])
    if table.sole is not None:
        lowest = table.sole.box_centre[2] - table.sole.box_half[2]
        if abs(table.sole.height - lowest) > LENGTH_TOLERANCE_M:
            yield ("sole", "height"), f"{table.sole.height} is not accepted; accepted: {lowest:g}, the box's lower face"
        yield from within(("sole", "sensor_pos", 2), table.sole.sensor_pos[2], (table.sole.height, 0.0), "in the foot")
    if table.leg is not None and "left" in table.feet:
        yield from _leg_problems(table, table.groups[table.feet["left"].limb])


def _leg_problems(table: RobotTable, joints: tuple[str, ...]) -> Iterator[Problem]:
    """Yield the geometry of a leg where it is not that of the bodies."""
    bodies = {row.name: row for row in table.bodies}
    moved = {row.id: row.body for row in table.joints}
    steps = [bodies[moved[joint]].pos for joint in joints if joint in moved]
    leg = table.leg
    if leg is None or not steps:
        return
    axes = {row.id: row.axis for row in table.joints}
    for side in table.feet:
        for joint, letter in zip(table.groups[table.feet[side].limb], LEG_AXES, strict=False):
            wanted = [float(letter == each) for each in "xyz"]
            if joint in axes and dist(axes[joint], wanted) > LENGTH_TOLERANCE_M:
                index = [row.id for row in table.joints].index(joint)
                yield ("joints", index, "axis"), misfit(list(axes[joint]), f"{wanted} of a leg that walks")
    if dist(leg.hip_pos, steps[0]) > LENGTH_TOLERANCE_M:
        yield ("leg", "hip_pos"), misfit(list(leg.hip_pos), f"{list(steps[0])}, that of {joints[0]}")
    for pos in steps[1:]:
        if (length := dist(pos, (0.0, 0.0, 0.0))) > 0.0 and abs(length - leg.link_length) > LENGTH_TOLERANCE_M:
            yield ("leg", "link_length"), misfit(leg.link_length, f"{length:g}, between the bodies of the leg")
            return


def _size_problems(table: RobotTable) -> Iterator[Problem]:
    """Yield inertias that no body of that mass has, and shapes of no length."""
    low, high = GYRATION_M
    for index, body in enumerate(table.bodies):
        radius = float(np.sqrt(max(body.inertia[:3]) / body.mass))
        if not low <= radius <= high:
            text = misfit(f"a radius of gyration of {radius:.3g} m", f"{low} to {high}, [kg m^2] and [kg]")
            yield ("bodies", index, "inertia"), text
    solids: Mapping[Place, Sequence[ShapeRow]] = {
        ("shapes",): table.shapes,
        ("looks", "shapes"): shapes_of_looks(table),
    }
    for place, index, shape in _numbered(solids):
        if shape.segment is not None and dist(shape.segment[:3], shape.segment[3:]) < LENGTH_TOLERANCE_M:
            yield (*place, index, "segment"), misfit(list(shape.segment), "two points that differ")


def _total_problems(table: RobotTable) -> Iterator[Problem]:
    """Yield totals that the rows do not add up to."""
    if table.totals is None:
        return
    nv = len(table.order.virtual)
    nu = len(table.order.actuated)
    counts: Mapping[str, int] = {
        "bodies": len(table.bodies),
        "actuated_joints": nu,
        "virtual_joints": nv,
        "dof": nv + nu,
    }
    for name, count in counts.items():
        if getattr(table.totals, name) != count:
            yield ("totals", name), f"{getattr(table.totals, name)} is not accepted; accepted: {count}, by the rows"
    mass = sum(body.mass for body in table.bodies)
    if abs(table.totals.mass - mass) > MASS_TOLERANCE * mass:
        yield ("totals", "mass"), f"{table.totals.mass} is not accepted; accepted: {mass:.6f}, by the rows"

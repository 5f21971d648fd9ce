"""What a robot's file tells of its inertial sensor and its feet, by names and places of its parts."""

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from mobnet.core.arrays import Array
from mobnet.core.joints import right_of
from mobnet.robot.import_tree import LinkTree, Part, RigidBody, heights_of

NAMED = re.compile("imu|inertial", re.IGNORECASE)
LEVEL_M = 0.02  # feet stand at one height, within this
TURN = 1e-6  # a smaller difference of axes is none


def sensors_of(
    tree: LinkTree, parts: Sequence[RigidBody], rows: Sequence[Mapping[str, Any]]
) -> tuple[dict[str, Any] | None, list[str]]:
    """Return the row of the inertial sensor on a floating base, None without one, and what else was found.

    A link or a site is taken for a sensor by its name; a site also if an accelerometer or a gyroscope is there.
    """
    row = None
    notes = list[str]()
    for name, body, pos, turn in _places(tree, parts):
        if body != 0:
            carrier = rows[body]["name"]
            base = rows[0]["name"]
            notes.append(f"{name}: an inertial sensor on {carrier}; a table has that of the base, {base}")
        elif row is not None:
            notes.append(f"{name}: another inertial sensor on the base; `imu` of the table is the first")
        else:
            row = {"body": rows[0]["name"], "pos": pos.tolist()}
            if np.abs(turn - np.eye(3)).max() > TURN:
                notes.append(f"{name}: its axes are not those of the base; a log takes its readings in base axes")
    return row, notes


def _places(tree: LinkTree, parts: Sequence[RigidBody]) -> Iterator[tuple[str, int, Array, Array]]:
    """Yield name, body, position (3,) [m] and axes (3, 3) in it of what looks like an inertial sensor."""
    places = dict[int, tuple[int, Part]]()
    for k, body in enumerate(parts):
        places |= {part.link: (k, part) for part in body.parts}
    for site in tree.sites:
        if site.link in places and (site.is_sensor or NAMED.search(site.name)):
            body, part = places[site.link]
            yield site.name, body, part.pos + part.turn @ site.pos, part.turn @ site.turn
    for link, (body, part) in sorted(places.items()):
        if NAMED.search(tree.links[link].name) and not (body == 0 and link == parts[0].parts[0].link):
            yield tree.links[link].name, body, part.pos, part.turn


def feet_of(
    turn: Array,
    parts: Sequence[RigidBody],
    rows: Sequence[Mapping[str, Any]],
    limbs: Mapping[str, Sequence[str]],
    joints: Sequence[Mapping[str, Any]],
) -> Iterator[str]:
    """Yield the pair of bodies at the ends of limbs that are lowest while all joints are at zero: feet, most likely.

    The base has the axes `turn` (3, 3).
    """
    places = dict(zip((row["name"] for row in rows), heights_of(parts, turn), strict=True))
    moved = {joint["id"]: joint["body"] for joint in joints}
    ends = {moved[chain[-1]]: limb for limb, chain in limbs.items()}
    heights = {body: places[body] for body in ends}
    lowest = min(heights.values(), default=0.0)
    feet = [body for body, height in heights.items() if height < lowest + LEVEL_M]
    pairs = [(body, right_of(body)) for body in feet if right_of(body) != body and right_of(body) in feet]
    for left, right in pairs:
        both = f"{{left: {{body: {left}, limb: {ends[left]}}}, right: {{body: {right}, limb: {ends[right]}}}}}"
        yield f"feet: these bodies at the ends of limbs are lowest: {both}; `sole` is to be added with them"

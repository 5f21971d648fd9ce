"""Mass and inertia of links that move as one, and what is done where no rigid body has such an inertia."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from mobnet.core.arrays import Array
from mobnet.formats.parts import GYRATION_M, MOST_KG, is_possible
from mobnet.robot.import_tree import Link, Part, RigidBody

# Of a body without mass between joints, [kg] and [kg m^2]: it changes no torque by a digit that counts, and MuJoCo
# simulates it.
TOKEN_MASS = 1e-12
TOKEN_INERTIA = 1e-14
TOKEN_SHARE = 1e-3  # of the mass of a body, below which a link with an impossible inertia stands for a frame
LIGHT_KG = 1e-3  # a link of less mass may get more, where its inertia asks for it
LARGE_M = 1.5  # a radius of gyration above this is told
SURE = 1.001  # by which a balanced moment is above the least one


@dataclass(frozen=True)
class Mass:
    """Mass [kg], centre of mass (3,) [m] and inertia about it (3, 3) [kg m^2], in a body's axes.

    `is_changed` says that they are not those of the file; `dropped` are links that were left out for it.
    """

    mass: float
    com: Array
    inertia: Array
    notes: list[str] = field(default_factory=list)
    is_changed: bool = False
    is_token: bool = False
    dropped: tuple[int, ...] = ()


def mass_of(body: RigidBody, links: Sequence[Link]) -> Mass:
    """Return the mass of a body as a table takes it, and notes on each change."""
    whole = Mass(*fused(body.parts))
    if not whole.mass and not whole.inertia.any():
        return Mass(TOKEN_MASS, np.zeros(3), TOKEN_INERTIA * np.eye(3), is_token=True)
    if is_rigid(whole.mass, whole.inertia):
        whole.notes.extend(_large(body.name, whole))
        return whole
    least = TOKEN_SHARE * whole.mass
    tokens = [part for part in body.parts if part.mass < least and part.inertia.any()]
    tokens = [part for part in tokens if not is_rigid(part.mass, part.inertia)]
    dropped = tuple(part.link for part in tokens)
    rest = fused([part for part in body.parts if part.link not in dropped])
    if is_rigid(rest[0], rest[2]):
        notes = list[str]()
        for part in tokens:
            text = _mass_text(part.mass, part.inertia)
            notes.append(f"{links[part.link].name}: {text} of no rigid body; left out")
        return Mass(*rest, notes, is_changed=True, dropped=dropped)
    mass, com, inertia = fused(body.parts)
    changed_mass, changed = balanced(mass, inertia)
    text = f"{body.name}: {_mass_text(mass, inertia)} of no rigid body; changed to {_mass_text(changed_mass, changed)}"
    return Mass(changed_mass, com, changed, [text], is_changed=True)


def fused(parts: Sequence[Part]) -> tuple[float, Array, Array]:
    """Return mass, centre of mass (3,) and inertia about it (3, 3) of parts together."""
    mass = sum(part.mass for part in parts)
    com = sum((part.mass * part.com for part in parts), np.zeros(3)) / (mass or 1.0)
    inertia = np.zeros((3, 3))
    for part in parts:
        lever = part.com - com
        inertia += part.inertia + part.mass * (lever @ lever * np.eye(3) - np.outer(lever, lever))
    return mass, com, inertia


def is_rigid(mass: float, inertia: Array) -> bool:
    """Return whether a table takes an inertia of a mass."""
    low, high = GYRATION_M
    return mass > 0.0 and is_possible(six(inertia)) and low <= _radius(mass, inertia) <= high


def faults_of(body: RigidBody, whole: Mass, links: Sequence[Link]) -> Iterator[str]:
    """Yield why a table does not take the mass of a body, by the names of the links that it comes from."""
    low, high = GYRATION_M
    if whole.mass > MOST_KG:
        heavy = [part for part in body.parts if part.mass > MOST_KG] or body.parts
        mass = sum(part.mass for part in heavy)
        yield f"{_links_text(heavy, links)}: mass {mass:g} kg is not accepted; accepted: above 0 to {MOST_KG:g} kg"
    if _radius(whole.mass, whole.inertia) > high:  # what is below the lower bound was raised to it
        wide = [part for part in body.parts if _radius(part.mass, part.inertia) > high] or body.parts
        mass, _, inertia = fused(wide)
        text = f"{_links_text(wide, links)}: {_mass_text(mass, inertia)}"
        radius = f"a radius of gyration of {_radius(mass, inertia):.3g} m"
        yield f"{text}, {radius} is not accepted; accepted: {low} to {high} m, of [kg] and [kg m^2]"


def _radius(mass: float, inertia: Array) -> float:
    """Return the largest radius of gyration [m]."""
    moment = float(np.diag(inertia).max())
    if moment <= 0.0:
        return 0.0
    return float(np.sqrt(moment / mass)) if mass else np.inf


def _links_text(parts: Sequence[Part], links: Sequence[Link]) -> str:
    """Return the names of the links of a body that have a mass."""
    names = [links[part.link].name for part in parts if part.mass or part.inertia.any()]
    return f"link{'s' if len(names) > 1 else ''} {', '.join(names)}"


def six(inertia: Array) -> tuple[float, float, float, float, float, float]:
    """Return xx yy zz xy xz yz of an inertia (3, 3), as a table has it."""
    (xx, xy, xz), (_, yy, yz), (_, _, zz) = inertia.tolist()
    return xx, yy, zz, xy, xz, yz


def balanced(mass: float, inertia: Array) -> tuple[float, Array]:
    """Return a mass and an inertia that a rigid body can have, near to one that none has.

    Axes stay. A principal moment that is too small for the mass is raised, and one above the sum of the others becomes
    that sum, because a single figure is wrong more often than two. Only a light body gets more mass.
    """
    least, most = GYRATION_M
    moments, axes = np.linalg.eigh(inertia)
    low, middle, high = np.maximum(moments, SURE * mass * least**2)
    high = min(high, low + middle)
    if mass < LIGHT_KG:
        mass = max(mass, SURE * high / most**2)
        low, middle, high = np.maximum((low, middle, high), SURE * mass * least**2)
    return float(mass), axes @ np.diag((low, middle, high)) @ axes.T


def _large(name: str, whole: Mass) -> Iterator[str]:
    """Yield that a radius of gyration is larger than that of links of robots."""
    radius = _radius(whole.mass, whole.inertia)
    if radius > LARGE_M:
        text = _mass_text(whole.mass, whole.inertia)
        yield f"{name}: {text}, a radius of gyration of {radius:.3g} m, as the file has it"


def _mass_text(mass: float, inertia: Array) -> str:
    """Return mass and principal moments as a text."""
    moments = ", ".join(f"{value:.4g}" for value in np.linalg.eigvalsh(inertia))
    return f"{mass:.4g} kg with the principal moments {moments} kg m^2"

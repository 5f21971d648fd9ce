"""The columns of recordings, residuals and estimates: who writes a file and who reads it take them from here."""

from collections.abc import Iterable
from itertools import chain

from mobnet.core.errors import ConfigError, not_accepted
from mobnet.core.joints import JointLayout

Column = tuple[str, str, str]  # name, unit, frame

# A column is `<signal>.<joint>`, of a foot `<signal>.<foot>`.
FEET = ("left_foot", "right_foot")
COMMAND = (("step_x", "m"), ("step_y", "m"), ("turn", "rad"), ("duration", "s"), ("foot_height", "m"))  # Table 2
VELOCITY = "v"
DESIRED = "tau_des"
MOTOR = "tau_motor"
SWING = "swing"
CONTACT = "contact"
PUSHED = "pushed"
LANDING = "landing"
PUSH = "push"
FORCE = (
    ("row", "-", "scenario"),
    *((f"force_{axis}", "N", "world") for axis in "xyz"),
)  # of a push on a robot that walks
RANDOM = "tau_random"  # what random torque exploration added to the desired torque
PUSH_TORQUE = "tau_push"  # what pushes alone add to the external torque
EXTERNAL = "tau_ext"  # of a recording: true; of an estimate: estimated
RESIDUAL, EXTERNAL_LP = "r", "tau_ext_lp"  # r of (9), and the true external torque behind the observer's low-pass, (15)
LABEL_LP = "label_lp"  # the external torque by the foot sensors, J^T F, behind the same low-pass
STD = "std"  # standard deviation that an estimate comes with


def named(signal: str, names: Iterable[str]) -> list[str]:
    """Return the columns of a signal of some joints or feet (n,)."""
    return [f"{signal}.{name}" for name in names]


def recording_columns(layout: JointLayout) -> dict[str, list[Column]]:
    """Return field -> columns (name, unit, frame) of a stored recording, in file order; some fields may have none."""
    actuated = layout.actuated
    xyz = "xyz" if layout.virtual else ""
    wxyz = "wxyz" if layout.virtual else ""
    feet = [foot for foot in FEET if foot.removesuffix("_foot") in layout.legs]
    wrench = [(f"force_{axis}", "N") for axis in "xyz"] + [(f"moment_{axis}", "N m") for axis in "xyz"]
    wrenches = dict[str, list[Column]]()
    for foot in FEET:
        components = wrench if foot in feet else []
        wrenches[f"wrench_{foot}"] = [(f"wrench_{foot}.{name}", unit, foot) for name, unit in components]
    base_v = [(f"v.base_{a}", "m/s", "world") for a in xyz] + [(f"v.omega_{a}", "rad/s", "base") for a in xyz]
    base_q = [(f"q.base_{a}", "m", "world") for a in xyz] + [(f"q.quat_{a}", "-", "world") for a in wxyz]
    places = [(j, (layout.unit(j), "world" if i < len(xyz) else "joint")) for i, j in enumerate(layout.names)]
    return {
        "q": base_q + [(f"q.{j}", "rad", "joint") for j in actuated],
        "v": base_v + [(f"{VELOCITY}.{j}", "rad/s", "joint") for j in actuated],
        "acc_base_in_base": [(f"acc.{a}", "m/s^2", "base") for a in xyz],
        "tau_des": [(f"{DESIRED}.{j}", "N m", "joint") for j in actuated],
        "tau_motor": [(f"{MOTOR}.{j}", "N m", "joint") for j in actuated],
        "swing": [(f"{SWING}.{foot}", "-", "plan") for foot in feet],
        "command": [(f"command.{name}", unit, "stance foot") for name, unit in COMMAND if feet],
        "landing": [(f"{LANDING}.{foot}", "s", "plan") for foot in feet],
        EXTERNAL: [(f"{EXTERNAL}.{joint}", *place) for joint, place in places],
        **wrenches,
        "contact": [(f"{CONTACT}.{foot}", "-", "ground") for foot in feet],
        "pushed": [(PUSHED, "-", "scenario")],
        "tau_random": [(f"{RANDOM}.{j}", "N m", "joint") for j in actuated],
        PUSH_TORQUE: [(f"{PUSH_TORQUE}.{joint}", *place) for joint, place in places],
        "push": [(f"{PUSH}.{name}", unit, frame) for name, unit, frame in FORCE if feet],
    }


def recording_width(layout: JointLayout) -> int:
    """Return the number of columns of a stored recording."""
    return sum(map(len, recording_columns(layout).values()))


def foot_of(layout: JointLayout, joint: str) -> str:
    """Return the foot, as named in a recording, of the leg that has a joint.

    Raises:
        ConfigError: the joint belongs to no leg.
    """
    legs = {side: layout.limb(limb) for side, limb in layout.legs.items()}
    for side, joints in legs.items():
        if joint in joints:
            return next(foot for foot in FEET if foot.startswith(side))
    raise ConfigError(not_accepted("leg joint", joint, chain.from_iterable(legs.values())))


def torque_columns(layout: JointLayout, signals: Iterable[str], joints: Iterable[str]) -> list[Column]:
    """Return the columns of torques of some joints, signal by signal, each with the unit and frame of its joint."""
    known = dict(zip(layout.names, recording_columns(layout)[EXTERNAL], strict=True))
    wanted = list(joints)
    columns = list[Column]()
    for signal in signals:
        columns += [(f"{signal}.{joint}", *known[joint][1:]) for joint in wanted]
    return columns


def residual_columns(layout: JointLayout, labelled: bool = False) -> list[Column]:
    """Return name, unit and frame of the columns of a residual file, (2 nv,), or (3 nv,) if foot sensors label it."""
    signals = (RESIDUAL, EXTERNAL_LP, LABEL_LP) if labelled else (RESIDUAL, EXTERNAL_LP)
    return torque_columns(layout, signals, layout.names)

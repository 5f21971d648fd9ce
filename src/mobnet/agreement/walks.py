"""Signals of a walk against each other: ground, feet, base and motors.

The ground carries the robot's weight, so that forces have the right sign and unit; flags of feet say where force is;
the base moves as its velocity says; and motors give about the torque that they are told.
"""

from collections.abc import Iterator
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.agreement.said import Signals
from mobnet.core.columns import CONTACT, DESIRED, EXTERNAL, FEET, MOTOR, SWING, named
from mobnet.core.errors import not_accepted
from mobnet.core.joints import JointLayout
from mobnet.plan.runs import Files

AXES = ("base_x", "base_y", "base_z")
WEIGHT = (0.5, 2.0)  # share of the weight that the ground carries on average
CARRIED = 0.5  # of the samples, from which on that is asked
FREE = 0.25  # share of the weight that no foot without contact carries on average
LOOSE, TOUCH_N = 0.2, 5.0  # share of the samples of a foot in contact that may have less force than this
BOTH = 0.1  # share of the samples in which both feet may swing
JUMP_M = 0.05  # in a sample: a simulator may shift the base's place
SPEED = (0.5, 2.0)  # ratio of the base's displacement to that of its velocity
LAG, LEAST_NM = 0.5, 1.0  # root mean square of what a motor's torque may differ by: share of the desired torque, least
REACH_M = 2.0  # more than any lever arm of a force on a foot
LEAST = 0.01  # share of the samples of a state that is compared
UP = "V3"


def walk_names(layout: JointLayout) -> list[str]:
    """Return the columns that are compared."""
    wrench = [f"wrench_{foot}.{kind}_{axis}" for foot in FEET for kind in ("force", "moment") for axis in "xyz"]
    legs = named(EXTERNAL, layout.limbs(layout.legs.values()))
    base = [f"{signal}.{axis}" for signal in "qv" for axis in AXES]
    motors = [name for signal in (DESIRED, MOTOR) for name in named(signal, layout.actuated)]
    return [f"{EXTERNAL}.{UP}", *wrench, *named(CONTACT, FEET), *named(SWING, FEET), *base, *legs, *motors]


def walk_faults(signals: Signals, rate_hz: float, files: Files) -> Iterator[str]:
    """Yield in what signals (T,) of a walk, by name, contradict each other; those that a file lacks are left out."""
    layout = files.settings.layout
    weight = sum(body.mass for body in files.settings.robot.bodies) * files.settings.plant.gravity_m_s2
    yield from _weight_faults(signals, weight)
    yield from _flag_faults(signals)
    yield from _contact_faults(signals, weight)
    yield from _base_faults(signals, rate_hz)
    yield from _lever_faults(signals, layout)
    for joint in layout.actuated:
        yield from _motor_faults(signals, joint)


def _weight_faults(signals: Signals, weight: float) -> Iterator[str]:
    """Yield forces of the ground that do not carry the robot, where it stands on its feet most of the time."""
    feet = [foot for foot in FEET if {f"wrench_{foot}.force_z", f"{CONTACT}.{foot}"} <= signals.keys()]
    if not feet or np.mean([signals[f"{CONTACT}.{foot}"].mean() for foot in feet]) < CARRIED:
        return
    means = {"wrench_*.force_z of both feet": float(sum(signals[f"wrench_{foot}.force_z"].mean() for foot in feet))}
    means |= {name: float(signals[name].mean()) for name in (f"{EXTERNAL}.{UP}",) if name in signals}
    for name, mean in means.items():
        if not WEIGHT[0] * weight <= mean <= WEIGHT[1] * weight:
            accepted = [f"about {weight:.0f} N, the robot's weight, upwards"]
            yield not_accepted(f"columns {name}: mean", round(mean, 3), accepted)


def _flag_faults(signals: Signals) -> Iterator[str]:
    """Yield flags of feet that are the wrong way round: a foot that touches, and one that does not swing, carries."""
    for foot, (flag, on) in product(FEET, ((CONTACT, 1.0), (SWING, 0.0))):
        state, force = signals.get(f"{flag}.{foot}"), signals.get(f"wrench_{foot}.force_z")
        if state is None or force is None or not LEAST < state.mean() < 1.0 - LEAST:
            continue
        loaded, free = float(force[state == on].mean()), float(force[state != on].mean())
        if loaded <= free:
            text = f"a mean force of {loaded:.1f} N where it is {on:g} and of {free:.1f} N elsewhere"
            yield not_accepted(f"column {flag}.{foot}", text, ["more force where the foot stands"])
    swings = [signals[name] for name in named(SWING, FEET) if name in signals]
    if len(swings) == len(FEET) and (both := float(np.mean(np.all(swings, axis=0)))) > BOTH:
        yield not_accepted(
            f"columns {SWING}.*: share of both at once", round(both, 3), [f"at most {BOTH:g}, in a walk"]
        )


def _contact_faults(signals: Signals, weight: float) -> Iterator[str]:
    """Yield contact without force, and force without contact."""
    for foot in FEET:
        state, force = signals.get(f"{CONTACT}.{foot}"), signals.get(f"wrench_{foot}.force_z")
        if state is None or force is None:
            continue
        off, on = force[state == 0.0], force[state == 1.0]
        if off.size and (mean := float(off.mean())) > FREE * weight:
            accepted = [f"at most {FREE * weight:.0f} N, or contact"]
            yield not_accepted(f"column {CONTACT}.{foot}: mean force where it is 0", round(mean, 1), accepted)
        if on.size and (loose := float(np.mean(on < TOUCH_N))) > LOOSE:
            accepted = [f"at most {LOOSE:g}"]
            yield not_accepted(f"column {CONTACT}.{foot}: share of 1 without force", round(loose, 3), accepted)


def _base_faults(signals: Signals, rate_hz: float) -> Iterator[str]:
    """Yield a base that goes elsewhere, or at another speed, than its velocity says, or is below the ground."""
    for axis in AXES:
        if not {f"q.{axis}", f"v.{axis}"} <= signals.keys():
            continue
        moved = np.clip(np.diff(signals[f"q.{axis}"]), -JUMP_M, JUMP_M) * rate_hz
        speed = signals[f"v.{axis}"][1:]
        along, size = float(moved @ speed), float(speed @ speed)
        if not SPEED[0] * size <= along <= SPEED[1] * size or (size == 0.0 and moved.any()):
            text = f"{along / size if size else np.inf:.3g} times what v.{axis} says"
            yield not_accepted(f"column q.{axis}: displacement", text, ["about 1"])
    if "q.base_z" in signals and (height := float(signals["q.base_z"].mean())) <= 0.0:
        yield not_accepted("column q.base_z: mean", round(height, 3), ["above 0, the ground"])


def _lever_faults(signals: Signals, layout: JointLayout) -> Iterator[str]:
    """Yield external torques of legs that no force on a foot of the size of the measured ones can cause."""
    size = {
        kind: max((float(np.abs(values).max()) for name, values in signals.items() if f".{kind}_" in name), default=0.0)
        for kind in ("force", "moment")
    }
    most = REACH_M * size["force"] + size["moment"]
    for name in named(EXTERNAL, layout.limbs(layout.legs.values())):
        if size["force"] and name in signals and (largest := float(np.abs(signals[name]).max())) > most:
            yield not_accepted(f"column {name}: largest number", largest, [f"at most {most:.0f} N m at these wrenches"])


def _motor_faults(signals: Signals, joint: str) -> Iterator[str]:
    """Yield a motor's torque that is far from the desired one."""
    if not {f"{DESIRED}.{joint}", f"{MOTOR}.{joint}"} <= signals.keys():
        return
    wanted, given = signals[f"{DESIRED}.{joint}"], signals[f"{MOTOR}.{joint}"]
    apart, most = rms(given - wanted), max(LAG * rms(wanted), LEAST_NM)
    if apart > most:
        text = f"{apart:.3g} N m away from {DESIRED}.{joint}"
        yield not_accepted(f"column {MOTOR}.{joint}", text, [f"at most {most:.3g} N m, root mean square"])


def rms(values: NDArray[Any]) -> float:
    """Return the root mean square of values (T,), in their unit."""
    return float(np.sqrt(np.mean(np.square(values))))

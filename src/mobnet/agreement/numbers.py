"""The numbers of recordings and residuals against what a walk of their scenario can be.

The ground carries the robot's weight, so that forces have the right sign and unit; nothing pushes where the scenario
pushes nothing; a residual stands beside the external torque of its recording.
"""

from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.agreement.arrays import NAMES
from mobnet.core.columns import COMMAND, EXTERNAL, EXTERNAL_LP, PUSH_TORQUE, RANDOM, RESIDUAL, named
from mobnet.core.errors import not_accepted
from mobnet.core.notes import read_array_note
from mobnet.core.store import ARRAY, NOTE, file_of, read_array
from mobnet.estimation.low_pass import low_pass
from mobnet.plan.runs import Files
from mobnet.settings.data import FixedCommand

FEET, AXES = ("left_foot", "right_foot"), ("base_x", "base_y")
WEIGHT = (0.5, 2.0)  # share of the weight that the ground carries on average
CARRIED = 0.5  # of the samples, from which on that is asked
JUMP_M = 0.05  # in a sample: a simulator may shift the base's place
SAME = 1e-3  # relative to the largest number of a column
LEAST = 0.01  # share of the samples of a state that is compared
UP = "V3"
KEYS = {  # column of a step's command -> key of the configuration
    "step_x": "step_x_m", "step_y": "step_y_m", "turn": "turn_deg", "duration": "duration_s",
    "foot_height": "foot_height_m",
}  # fmt: skip
Signals = Mapping[str, NDArray[Any]]


def number_faults(path: Path, place: tuple[str, ...], files: Files) -> Iterator[str]:
    """Yield what is wrong with the numbers of a recording or a residual at its place."""
    kind, *_, name = place
    found = NAMES.fullmatch(name)
    if path.suffix != ARRAY or kind not in ("recordings", "residuals") or len(place) != 4 or not found:
        return
    scenario, level, stem = place[1], place[2], path.with_suffix("")
    if scenario not in files.settings.scenarios or files.settings.robot.base != "floating":
        return
    if kind == "recordings":
        signals = _read(stem, _ground_names())
        yield from (*_weight_faults(signals, files), *_flag_faults(signals), *_direction_faults(signals))
        yield from _scenario_faults(stem, scenario, files)
    else:
        yield from _residual_faults(stem, files.array("recordings", scenario, level, found[1]), files)


def _read(stem: Path, names: Sequence[str]) -> dict[str, NDArray[Any]]:
    """Return columns of an array that it has, by name, each (T,)."""
    held = {column["name"] for column in read_array_note(file_of(stem, NOTE))["columns"]}
    wanted = [name for name in names if name in held]
    array = read_array(stem, wanted)[0].astype(np.float64)
    return dict(zip(wanted, array.T, strict=True))


def _ground_names() -> list[str]:
    """Return the columns that say how the ground carries the robot and where that goes."""
    force = [f"wrench_{foot}.force_z" for foot in FEET]
    flags = [f"{flag}.{foot}" for flag in ("contact", "swing") for foot in FEET]
    return [f"{EXTERNAL}.{UP}", *force, *flags, *(f"{signal}.{axis}" for signal in "qv" for axis in AXES)]


def _weight_faults(signals: Signals, files: Files) -> Iterator[str]:
    """Yield forces of the ground that do not carry the robot, where it stands on its feet most of the time."""
    feet = [foot for foot in FEET if {f"wrench_{foot}.force_z", f"contact.{foot}"} <= signals.keys()]
    if not feet or np.mean([signals[f"contact.{foot}"].mean() for foot in feet]) < CARRIED:
        return
    weight = sum(body.mass for body in files.settings.robot.bodies) * files.settings.plant.gravity_m_s2
    means = {"wrench_*.force_z of both feet": float(sum(signals[f"wrench_{foot}.force_z"].mean() for foot in feet))}
    means |= {name: float(signals[name].mean()) for name in (f"{EXTERNAL}.{UP}",) if name in signals}
    for name, mean in means.items():
        if not WEIGHT[0] * weight <= mean <= WEIGHT[1] * weight:
            accepted = [f"about {weight:.0f} N, the robot's weight, upwards"]
            yield not_accepted(f"columns {name}: mean", round(mean, 3), accepted)


def _flag_faults(signals: Signals) -> Iterator[str]:
    """Yield flags of feet that are the wrong way round: a foot that touches, and one that does not swing, carries."""
    for foot, (flag, on) in product(FEET, (("contact", 1.0), ("swing", 0.0))):
        state, force = signals.get(f"{flag}.{foot}"), signals.get(f"wrench_{foot}.force_z")
        if state is None or force is None or not LEAST < state.mean() < 1.0 - LEAST:
            continue
        loaded, free = float(force[state == on].mean()), float(force[state != on].mean())
        if loaded <= free:
            text = f"a mean force of {loaded:.1f} N where it is {on:g} and of {free:.1f} N elsewhere"
            yield not_accepted(f"column {flag}.{foot}", text, ["more force where the foot stands"])


def _direction_faults(signals: Signals) -> Iterator[str]:
    """Yield a base that goes against its velocity."""
    for axis in AXES:
        if {f"q.{axis}", f"v.{axis}"} <= signals.keys():
            moved = np.clip(np.diff(signals[f"q.{axis}"]), -JUMP_M, JUMP_M)
            if moved @ signals[f"v.{axis}"][1:] < 0.0:
                yield not_accepted(f"column q.{axis}", "against v", [f"the direction of v.{axis}"])


def _scenario_faults(stem: Path, scenario: str, files: Files) -> Iterator[str]:
    """Yield torques, pushes and commands that the scenario does not have."""
    settings, row = files.settings, files.settings.scenarios[scenario]
    random, pushed = named(RANDOM, settings.layout.actuated), named(PUSH_TORQUE, settings.layout.names)
    signals = _read(stem, [*random, *pushed, "pushed", *named("command", [name for name, _ in COMMAND])])
    absent = [*(() if row.random_torque else random), *(() if row.pushes else (*pushed, "pushed"))]
    for name in absent:
        if name in signals and signals[name].any():
            largest = float(np.abs(signals[name]).max())
            yield not_accepted(f"column {name}: largest number", largest, [f"0 everywhere, as {scenario} has none"])
    acting = np.any([signals[name] != 0.0 for name in pushed if name in signals], axis=0)
    if "pushed" in signals and np.any(acting & (signals["pushed"] == 0.0)):
        first = int(np.argmax(acting & (signals["pushed"] == 0.0)))
        yield not_accepted(f"column pushed, row {first}", 0.0, ["1 where tau_push acts"])
    for name, _ in COMMAND:
        yield from _command_faults(name, signals.get(f"command.{name}"), scenario, files)


def _command_faults(name: str, found: NDArray[Any] | None, scenario: str, files: Files) -> Iterator[str]:
    """Yield commands that are neither zero nor within the range of a scenario."""
    key = KEYS[name]
    asked = files.settings.scenarios[scenario].commands
    values = getattr(asked if isinstance(asked, FixedCommand) else files.settings.commands, key)
    scale = np.pi / 180.0 if key.endswith("_deg") else 1.0
    low, high = (scale * end for end in ((values, values) if isinstance(values, float) else (min(values), max(values))))
    if found is None:
        return
    margin = SAME * max(abs(low), abs(high), SAME)
    beyond = (found != 0.0) & ((found < min(low, 0.0) - margin) | (found > max(high, 0.0) + margin))
    if beyond.any():
        row = int(np.argmax(beyond))
        yield not_accepted(f"column command.{name}, row {row}", float(found[row]), [f"0, or {low:g} to {high:g}"])


def _residual_faults(stem: Path, recording: Path, files: Files) -> Iterator[str]:
    """Yield external torques that are not the recording's behind the low-pass, and a residual that is not theirs."""
    layout, observer = files.settings.layout, files.settings.observer
    if not file_of(recording, NOTE).exists():
        return
    signals = _read(stem, [*named(EXTERNAL_LP, layout.names), *named(RESIDUAL, layout.names)])
    truth = _read(recording, named(EXTERNAL, layout.names))
    segments, rate = (read_array_note(file_of(stem, NOTE))[key] for key in ("segments", "rate_hz"))
    for joint in layout.names:
        exact, found = truth[f"{EXTERNAL}.{joint}"], signals[f"{EXTERNAL_LP}.{joint}"]
        for start, end in segments:
            wanted = low_pass(exact[start:end, None], observer.gain_hz, rate)[:, 0]
            apart, size = float(np.abs(wanted - found[start:end]).max()), float(np.abs(wanted).max())
            if apart > SAME * max(size, 1.0):
                accepted = [f"{EXTERNAL}.{joint} of its recording behind the low-pass of (11)"]
                yield not_accepted(f"column {EXTERNAL_LP}.{joint}: difference", apart, accepted)
                break
    up, wanted = float(signals[f"{RESIDUAL}.{UP}"].mean()), float(signals[f"{EXTERNAL_LP}.{UP}"].mean())
    if not WEIGHT[0] * wanted <= up <= WEIGHT[1] * wanted:
        yield not_accepted(f"column {RESIDUAL}.{UP}: mean", up, [f"about {wanted:.0f} N, the mean external force"])

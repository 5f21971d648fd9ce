"""The numbers of recordings, residuals and estimates at their places.

A recording is a walk (`mobnet.agreement.walks`) of its scenario: nothing pushes where the scenario pushes nothing. A
residual or an estimate stands beside what it was made from (`mobnet.agreement.derived`).
"""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.agreement.arrays import NAMES
from mobnet.agreement.derived import estimate_faults, residual_faults
from mobnet.agreement.motions import knot_faults
from mobnet.agreement.said import SAME, Signals, signals_of
from mobnet.agreement.walks import walk_faults, walk_names
from mobnet.core.columns import COMMAND, PUSH_TORQUE, PUSHED, RANDOM, named
from mobnet.core.errors import not_accepted
from mobnet.core.files import read_json
from mobnet.core.notes import read_array_note
from mobnet.core.store import ARRAY, NOTE, file_of
from mobnet.plan.runs import Files
from mobnet.settings.data import FixedCommand, Push, RandomTorque

IDLE = 0.1  # share of the samples marked as pushed in which nothing may push
KEYS = {  # column of a step's command -> key of the configuration
    "step_x": "step_x_m", "step_y": "step_y_m", "turn": "turn_deg", "duration": "duration_s",
    "foot_height": "foot_height_m",
}  # fmt: skip


def number_faults(path: Path, place: tuple[str, ...], files: Files) -> Iterator[str]:
    """Yield what is wrong with the numbers of a recording, residual or estimate at its place."""
    if place[0] == "motions":
        yield from (*_copy_faults(path, "motions"), *knot_faults(path, place, files))
    if len(place) != (6 if place[0] == "estimates" else 4):
        return
    kind, *owner, scenario, level, name = place
    found, stem = NAMES.fullmatch(name), path.with_suffix("")
    if path.suffix != ARRAY or not found or scenario not in files.settings.scenarios:
        return
    yield from _copy_faults(path, kind)
    if files.settings.robot.base != "floating":
        return
    recording, residual = (files.array(of, scenario, level, found[1]) for of in ("recordings", "residuals"))
    if kind == "recordings":
        rate = read_array_note(file_of(stem, NOTE))["rate_hz"]
        yield from walk_faults(signals_of(stem, walk_names(files.settings.layout)), rate, files)
        yield from _scenario_faults(stem, scenario, files)
    elif kind == "residuals":
        yield from residual_faults(stem, recording, files)
    elif kind == "estimates" and owner[0] in files.catalogue.all_methods:
        yield from estimate_faults(stem, residual, files.catalogue.all_methods[owner[0]])


def _copy_faults(path: Path, kind: str) -> Iterator[str]:
    """Yield another recording, residual or motion of the same scenario and level whose array is the same."""
    own = read_json(path.with_suffix(NOTE)).get("footer")
    for other in sorted(path.parent.glob(f"s*{NOTE}")) if own and kind != "estimates" else ():
        if other.stem != path.stem and read_json(other).get("footer") == own:
            yield not_accepted("array", f"that of {other.stem}", ["numbers of its own, as seeds differ"])


def _scenario_faults(stem: Path, scenario: str, files: Files) -> Iterator[str]:
    """Yield torques, pushes and commands that the scenario does not have, or lacks."""
    settings, row = files.settings, files.settings.scenarios[scenario]
    random, pushed = named(RANDOM, settings.layout.actuated), named(PUSH_TORQUE, settings.layout.names)
    signals = signals_of(stem, [*random, *pushed, PUSHED, *named("command", [name for name, _ in COMMAND])])
    absent = [*(() if row.random_torque else random), *(() if row.pushes else (*pushed, PUSHED))]
    for name in absent:
        if name in signals and signals[name].any():
            largest = float(np.abs(signals[name]).max())
            yield not_accepted(f"column {name}: largest number", largest, [f"0 everywhere, as {scenario} has none"])
    if row.random_torque:
        yield from _random_faults(signals, random, files.settings.random_torque_of(scenario))
    yield from _push_faults(signals, pushed, [settings.pushes[name] for name in row.pushes])
    for name, _ in COMMAND:
        yield from _command_faults(name, signals.get(f"command.{name}"), scenario, files)


def _random_faults(signals: Signals, names: Sequence[str], random: RandomTorque) -> Iterator[str]:
    """Yield random torques that are zero everywhere, or above their largest."""
    held = {name: float(np.abs(signals[name]).max()) for name in names if name in signals}
    if held and not any(held.values()):
        yield not_accepted(f"columns {RANDOM}.*: largest number", 0.0, ["random torques, as the scenario has them"])
    most = max(random.legs_waist_nm, random.neck_nm, *random.arms_nm)
    for name, largest in held.items():
        if largest > most * (1.0 + SAME):
            yield not_accepted(f"column {name}: largest number", largest, [f"at most {most:g}"])


def _push_faults(signals: Signals, names: Sequence[str], pushes: Sequence[Push]) -> Iterator[str]:
    """Yield pushes that are not marked, marks without a push, and torques on joints that no push turns so."""
    held = {name: signals[name] for name in names if name in signals}
    acting = np.any([values != 0.0 for values in held.values()], axis=0)
    if PUSHED in signals and held and pushes:
        marked = signals[PUSHED] != 0.0
        if np.any(acting & ~marked):
            first = int(np.argmax(acting & ~marked))
            yield not_accepted(f"column {PUSHED}, row {first}", 0.0, [f"1 where {PUSH_TORQUE} acts"])
        if marked.any() and (idle := float(np.mean(~acting[marked]))) > IDLE:
            yield not_accepted(f"column {PUSHED}: share of 1 without {PUSH_TORQUE}", idle, [f"at most {IDLE:g}"])
    turned = {f"{PUSH_TORQUE}.{push.joint}": push for push in pushes if push.joint}
    if len(turned) < len(pushes) or not pushes:
        return
    for name, values in held.items():
        largest = float(np.abs(values).max())
        if name not in turned and largest > 0.0:
            yield not_accepted(f"column {name}: largest number", largest, [f"0, as pushes turn {', '.join(turned)}"])
        elif name in turned and largest > (most := _most_nm(turned[name])) * (1.0 + SAME):
            yield not_accepted(f"column {name}: largest number", largest, [f"at most {most:g}"])
        elif name in turned and largest == 0.0 and acting.any():
            yield not_accepted(f"column {name}: largest number", 0.0, ["a torque, as its joint is pushed"])


def _most_nm(push: Push) -> float:
    """Return the largest torque of a push on a joint [N m]: amplitudes of a sum of sines add up."""
    return max(map(abs, push.torque_nm or (0.0,))) * (sum(push.sines.share) if push.sines else 1.0)


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

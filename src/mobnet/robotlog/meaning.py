"""Which columns of a log are which signals: a map by full names, and that of a log without one."""

from collections.abc import Collection, Iterator, Sequence
from itertools import chain
from pathlib import Path

from mobnet.core.columns import EXTERNAL, FEET, PUSHED, recording_columns
from mobnet.core.errors import ConfigError, DataError, not_accepted, refuse
from mobnet.core.joints import JointLayout
from mobnet.formats.log_map import Clock, LogMap, Signal
from mobnet.robotlog.hints.columns import listed

MOTORS = ("q", "v", "tau_motor")
BASE = ("quaternion", "velocity", "omega", "acc")  # what a floating base needs
JOINT_STATE = {"q": "position", "v": "velocity", "tau_motor": "effort"}  # fields of ROS's message
CLOCKS = ("time", "timestamp", "t")  # usual names of a clock, in the order in which they are looked for
AXES = ("x", "y", "z")
WRENCH = (*(f"force.{axis}" for axis in AXES), *(f"torque.{axis}" for axis in AXES))
ENDS = {  # signal -> how messages of ROS name its numbers
    **dict.fromkeys(("position", "velocity", "omega", "acc"), AXES),
    "quaternion": ("w", *AXES),
    **dict.fromkeys((*FEET, "tool"), WRENCH),
}


def given_signals(meaning: LogMap) -> dict[str, Signal]:
    """Return the signals that a map has."""
    return {name: signal for name in LogMap.model_fields if isinstance(signal := getattr(meaning, name), Signal)}


def default_map(path: Path, names: Collection[str], layout: JointLayout) -> LogMap:
    """Return the map of a log whose columns have the names of a recording (docs/data.md), with a clock of a usual name.

    Of messages it is the topic with a JointState of all joints, if there is a single one and the base is fixed.

    Raises:
        DataError: the log has no such columns, and needs a map.
    """
    fields = recording_columns(layout)
    taken = dict[str, Signal]()
    there = set(names)
    base = 7 if layout.virtual else 0
    signals = dict[str, list[str]]()
    for key, group in fields.items():
        signals[key] = [name for name, *_ in group]
    groups = {
        "q": signals["q"][base:],
        "v": signals["v"][6 if base else 0 :],
        "tau_motor": signals["tau_motor"],
        "position": signals["q"][:3] if base else [],
        "quaternion": signals["q"][3:base],
        "acc": signals["acc_base_in_base"],
        "velocity": signals["v"][:3] if base else [],
        "omega": signals["v"][3:6] if base else [],
        **{foot: signals[f"wrench_{foot}"] for foot in FEET},
        "swing": signals["swing"],
        "landing": signals["landing"],
    }
    if not any(there.intersection(groups[key]) for key in MOTORS):
        # A JointState says nothing of a base, so that no map can be guessed for one that floats.
        if base:
            raise DataError(f"{path}: {_needs_map(names, groups['q'])}")
        groups = {key: [f"{_joint_state(path, names, layout)}.{field}"] for key, field in JOINT_STATE.items()}
    for key, group in groups.items():
        if group and (key in MOTORS or set(group) <= there):
            taken[key] = Signal(columns=tuple(group))
    clocks = [name for name in names if name.lower() in CLOCKS]
    clock = min(clocks, key=lambda name: CLOCKS.index(name.lower()), default=CLOCKS[0])
    return LogMap.model_validate({**taken, "clock": Clock(column=clock)})


def _needs_map(names: Collection[str], unit_names: Sequence[str]) -> str:
    """Return the message about a log whose columns a map has to name."""
    return f"has no column {unit_names[0]} or the like; accepted: a --map of its columns, which are {listed([*names])}"


def _joint_state(path: Path, names: Collection[str], layout: JointLayout) -> str:
    """Return the single topic of a log of messages that has a JointState of all joints.

    Raises:
        DataError: there is none, or several; the line says what the nearest one lacks.
    """
    topics: dict[str, dict[str, set[str]]] = {}  # -> field -> joints
    for name in names:
        for field in JOINT_STATE.values():
            topic, between, joint = name.partition(f".{field}.")
            if between and topic.startswith("/"):
                topics.setdefault(topic, {}).setdefault(field, set()).add(joint)
    joints = set(layout.actuated)
    whole = list[str]()
    for topic, fields in topics.items():
        if all(joints <= fields.get(field, set()) for field in JOINT_STATE.values()):
            whole.append(topic)
    if len(whole) == 1:
        return whole[0]
    if whole:
        accepted = f"a --map that names one, such as `q: {{columns: [{whole[0]}.position]}}`"
        raise DataError(f"{path}: {' and '.join(whole)} have all joints of the robot; accepted: {accepted}")
    if not topics:
        raise DataError(f"{path}: {_needs_map(names, [f'q.{layout.actuated[0]}'])}")
    # The topic with most of the joints is likely the one that is meant: the line says what it lacks.
    near = max(topics, key=lambda topic: len(joints & set().union(*topics[topic].values())))
    for field in JOINT_STATE.values():
        if field not in topics[near]:
            raise DataError(f"{path}: {near}: {field} is empty; accepted: position, velocity and effort of each joint")
        if missing := [joint for joint in layout.actuated if joint not in topics[near][field]]:
            joint_names = sorted(topics[near][field])
            accepted = "all joints of the robot, or `joints` of a --map for other names"
            raise DataError(
                f"{path}: {near}: {field} has {listed(joint_names)}, and not {listed(missing)}; accepted: {accepted}"
            )
    raise DataError(f"{path}: {_needs_map(names, layout.actuated)}")


def resolved(path: Path, meaning: LogMap, names: Collection[str], layout: JointLayout) -> LogMap:
    """Return a map whose signals name each column that they need, all of which the log has.

    A topic or field alone stands for the columns below it: by the names of joints, by axes, or by numbers.

    Raises:
        ConfigError: the map does not fit the robot.
        DataError: a column is missing; the line has the names that are most like it.
    """
    given = given_signals(meaning)
    there = set(names)
    needed = [*MOTORS, *(BASE if layout.virtual else ())]
    if missing := [name for name in needed if name not in given]:
        why = "a robot with a floating base, such as the one taken without --robot, needs them"
        raise ConfigError(f"{path}: {', '.join(missing)}: missing in the map; {why}")
    if meaning.joints and len(meaning.joints) != layout.nu:
        raise ConfigError(f"{path}: joints: {not_accepted('number', len(meaning.joints), [layout.nu])}")
    widths = dict.fromkeys(MOTORS, layout.nu) | {name: len(ends) for name, ends in ENDS.items()}
    widths |= dict.fromkeys(("swing", "landing"), len(layout.legs))
    joints = meaning.joints or layout.actuated
    full = {key: _full(key, signal, there, joints, widths[key]) for key, signal in given.items()}
    faults = list[str]()
    for key, signal in full.items():
        faults += _faults(key, signal, names, widths[key])
    refuse(path, faults)
    return meaning.model_copy(update=full)


def wanted_columns(meaning: LogMap, names: Collection[str]) -> list[str]:
    """Return the columns that a map by full names needs, with its clock and the truth where the log has them."""
    of_signals = chain.from_iterable(signal.columns for signal in given_signals(meaning).values())
    clock = [name for name in names if name == meaning.clock.column]
    return list(dict.fromkeys([*clock, *of_signals, *filter(is_truth, names)]))


def is_truth(name: str) -> bool:
    """Return whether a column is one of those by which a simulated log tells its pushes."""
    return name == PUSHED or name.startswith(f"{EXTERNAL}.")


def _full(key: str, signal: Signal, there: Collection[str], joints: Collection[str], width: int) -> Signal:
    """Return a signal with the columns below the one that it names, if it names one alone."""
    stem = signal.columns[0]
    if len(signal.columns) > 1 or (stem in there and width == 1):
        return signal
    named = [f"{stem}.{end}" for end in (joints if key in MOTORS else ENDS.get(key, ()))]
    numbered = [f"{stem}.{k}" for k in range(width)]
    by_names = [stem.replace("*", joint) for joint in joints] if key in MOTORS else []
    by_numbers = [stem.replace("*", str(k)) for k in range(width)]
    starred = [by_names, by_numbers] if "*" in stem else []
    # Names before numbers, as messages may list joints and axes in any order.
    for columns in (named, *starred, numbered):
        if columns and set(columns) <= set(there):
            by_name = {"order": "wxyz"} if key == "quaternion" and columns is named else {}
            return signal.model_copy(update={"columns": tuple(columns), **by_name})
    return signal


def _faults(key: str, signal: Signal, names: Collection[str], width: int) -> Iterator[str]:
    """Yield what does not fit about the columns of a signal."""
    count = len(signal.columns)
    there = set(names)
    missing = [name for name in signal.columns if name not in there]
    if missing:
        more = f"; {len(missing) - 1} more columns of {key} are missing" if len(missing) > 1 else ""
        yield not_accepted("column", missing[0], names) + more
    if count != width and not missing:
        yield f"{key}.columns: {not_accepted('number', count, [width])}"
    for part in ("sign", "scale", "offset"):
        value = getattr(signal, part)
        if isinstance(value, tuple) and len(value) != width:
            yield f"{key}.{part}: {not_accepted('number', len(value), [1, width])}"

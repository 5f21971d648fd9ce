"""What must hold for terrains, commands, motions, pushes, scenarios and training sets."""

from collections.abc import Iterator
from itertools import chain, pairwise, product
from math import isclose
from typing import cast

from experiments.settings.settings import Settings
from mobnet.core.errors import misfit, not_accepted
from mobnet.formats.faults import as_many, at_least, at_most, below, within
from mobnet.formats.reading import Place, Problem
from mobnet.settings.data import FixedCommand, Motion, Push, Scenario

PACKED = 0.5  # share of the ground that plates drawn one by one can cover

# Training sets that tables and figures of the paper compare by name.
FIRST_SETS = ("walk", "walk_plain")
NARROW = 1e-9


def data_problems(settings: Settings) -> Iterator[Problem]:
    """Yield what does not fit in the sections of data."""
    for check in (_terrain_problems, _command_problems, _torque_problems, _motion_problems, _push_problems):
        yield from check(settings)
    for name, row in settings.scenarios.items():
        yield from (((("scenarios", name, *place)), text) for place, text in _scenario_problems(settings, name, row))
    yield from _set_problems(settings)


def _terrain_problems(settings: Settings) -> Iterator[Problem]:
    """Yield edges wider than what they belong to, plates that find no room, and heights that no foot clears."""
    checks = settings.terrain.checks
    plates = settings.terrain.plates
    least = min(settings.commands.foot_height_m)
    if checks:
        yield from below(("terrain", "checks", "bevel_m"), checks.bevel_m, checks.cell_m / 2, "half of cell_m")
    if plates:
        sides = list(chain.from_iterable(plates.sizes_m))
        yield from below(("terrain", "plates", "bevel_m"), plates.bevel_m, min(sides) / 2, "half of a plate's side")
        area = sum(length * width for length, width in plates.sizes_m)
        if max(sides) + plates.gap_m > plates.period_m or area > PACKED * plates.period_m**2:
            accepted = (
                f"a plate of {max(sides)} m and its gap within it, and {PACKED:.0%} of its square above {area:g} m^2"
            )
            yield ("terrain", "plates", "period_m"), misfit(plates.period_m, accepted)
    heights: dict[Place, float] = {} if checks is None else {("checks", "height_m", 1): checks.height_m[1]}
    heights |= {} if plates is None else {("plates", "height_m"): plates.height_m}
    for place, height in heights.items():
        yield from below(("terrain", *place), height, least, "the lowest foot_height_m")


def _command_problems(settings: Settings) -> Iterator[Problem]:
    """Yield ranges without zero, from which all walks start, and probabilities that are no distribution."""
    commands = settings.commands
    for name in ("step_x_m", "step_y_m", "turn_deg"):
        low, high = getattr(commands, name)
        if not low <= 0.0 <= high:
            yield ("commands", name), misfit([low, high], "a range that contains 0")
    for name, law in (("random", commands.random), ("joystick", commands.joystick)):
        total = sum(law.kinds.values())
        if not isclose(total, 1.0, abs_tol=NARROW):
            yield ("commands", name, "kinds"), misfit(f"a sum of {total:g}", "probabilities with the sum 1")
    steps = (settings.recording.episode_s + settings.recording.settle_s) / settings.walking.step_min_s
    place = ("recording", "episode_steps")
    most = settings.recording.episode_steps
    yield from at_least(place, most, steps, "the steps of an episode")


def _torque_problems(settings: Settings) -> Iterator[Problem]:
    """Yield random torques that are not those of the robot's joints."""
    limits = {joint.id: joint.torque_limit for joint in settings.robot.joints}
    groups = settings.robot.groups
    torque = settings.random_torque
    for limb in ("LA", "RA"):
        place = ("random_torque", "arms_nm")
        joints = groups.get(limb, ())
        if joints:
            yield from as_many(place, len(torque.arms_nm), len(joints), f"one for each joint of {limb}")
        for index, (joint, value) in enumerate(zip(joints, torque.arms_nm, strict=False)):
            yield from at_most((*place, index), value, limits[joint], f"limit of {joint}")
    for name, limbs in (("legs_waist_nm", ("LL", "RL", "W")), ("neck_nm", ("N",))):
        joints = chain.from_iterable(groups.get(limb, ()) for limb in limbs)
        most = min((limits[joint] for joint in joints), default=0.0)
        value = getattr(torque, name)
        yield from at_most(("random_torque", name), value, most, "the least limit of a motor")


def _motion_problems(settings: Settings) -> Iterator[Problem]:
    """Yield motions that do not fit the robot, or whose numbers stand in the wrong order."""
    for name, motion in settings.motions.items():
        for place, text in (*_joint_range_problems(settings, motion), *_shape_problems(motion)):
            yield ("motions", name, *place), text
        if not settings.robot.shapes:
            yield ("motions", name), misfit("a robot without shapes", "shapes, which keep hands and legs apart")


def _joint_range_problems(settings: Settings, motion: Motion) -> Iterator[Problem]:
    """Yield working ranges that are not as many as the joints, leave their limits or miss the posture."""
    robot = settings.robot
    limits = {joint.id: joint.range for joint in robot.joints}
    posture = robot.posture_rad
    for name, limb in (("waist_rad", "W"), ("neck_rad", "N"), ("arm_rad", "LA")):
        spans = getattr(motion, name)
        joints = robot.groups.get(limb, ())
        if len(spans) != len(joints):
            yield (name,), misfit(f"{len(spans)} ranges", f"{len(joints)}, one for each joint of {limb}")
        for index, (joint, (low, high)) in enumerate(zip(joints, spans, strict=False)):
            least, most = limits[joint]
            if low < least or high > most or not low <= posture.get(joint, low) <= high:
                accepted = f"within {least} to {most} of {joint}, and its posture {posture.get(joint)} inside"
                yield (name, index), misfit([low, high], accepted)
    for index, (joint, (low, high)) in enumerate(zip(robot.groups.get("RA", ()), motion.arm_rad, strict=False)):
        least, most = limits[joint]
        if -high < least or -low > most or not -high <= posture.get(joint, -low) <= -low:
            accepted = f"ranges whose mirror image lies within {least} to {most} of {joint}, with its posture inside"
            yield ("arm_rad", index), misfit([low, high], accepted)
    legs = robot.groups[robot.feet["left"].limb] if "left" in robot.feet else ()
    for index, pose in enumerate(motion.leg_poses_rad):
        for k, (joint, angle) in enumerate(zip(legs, pose, strict=False)):
            yield from within(("leg_poses_rad", index, k), angle, limits[joint], f"the range of {joint}")


def _shape_problems(motion: Motion) -> Iterator[Problem]:
    """Yield distances and frequencies of a motion that stand in the wrong order, and variants that are the same."""
    fastest = max(variant.speed for variant in motion.variants) * motion.band_hz[1]
    if fastest >= motion.knot_hz / 2:
        text = misfit(motion.band_hz[1], f"below half of knot_hz, times the fastest variant: {fastest:g}")
        yield ("band_hz", 1), text
    for low, high in (("clearance_least_m", "clearance_m"), ("clearance_m", "guard_m")):
        yield from at_most((low,), getattr(motion, low), getattr(motion, high), high)
    for index, variant in enumerate(motion.variants):
        if variant in motion.variants[:index]:
            yield ("variants", index), misfit("the same variant twice", "variants that differ")


def _push_problems(settings: Settings) -> Iterator[Problem]:
    """Yield pushes that are neither a force nor a torque, have no times or two kinds of them, or meet each other."""
    for name, push in settings.pushes.items():
        for place, text in _push_faults(push):
            yield ("pushes", name, *place), text
        for index, (before, after) in enumerate(pairwise(push.at_s or ()), start=1):
            end_s = before + push.duration_s[1]
            yield from at_least(("pushes", name, "at_s", index), after, end_s, "the end of the push before")


def _push_faults(push: Push) -> Iterator[Problem]:
    """Yield keys of a push that do not go together."""
    wanted = {"point", "force_n", "direction"} if push.joint is None else {"joint", "torque_nm"}
    given = push.model_fields_set & {"point", "force_n", "direction", "joint", "torque_nm"}
    if given != wanted:
        accepted = "`point`, `force_n` and `direction`, or `joint` and `torque_nm`"
        yield (), misfit(", ".join(sorted(given)) or "neither force nor torque", accepted)
    if push.moment_nm and push.joint:
        yield ("moment_nm",), misfit(list(push.moment_nm), "`moment_nm` beside a force only")
    if (push.shape == "sines") != (push.sines is not None):
        yield (), misfit("`shape: sines` without `sines`, or the other way round", "both or neither")
    if (push.shape == "impactor") != (push.impactor_kg is not None) or (push.shape == "impactor" and not push.point):
        accepted = "`impactor_kg` with `shape: impactor` and a `point`, or neither"
        yield (), misfit("`shape: impactor` without `impactor_kg` or `point`, or the other way round", accepted)
    if push.sines and len({len(numbers) for _, numbers in push.sines}) > 1:
        yield ("sines",), misfit("lists of different lengths", "a frequency, a phase and a share for each line")
    if (push.pause_s is None) == (push.at_s is None):
        yield (), misfit("no time" if push.at_s is None else "`pause_s` with `at_s`", "`pause_s` or `at_s`")
    if push.during == "always" and "share" in push.model_fields_set:
        yield ("share",), misfit(list(push.share), "`share` of a push `during` a swing or a support only")


def _scenario_problems(settings: Settings, name: str, row: Scenario) -> Iterator[Problem]:
    """Yield what does not fit in a scenario."""
    commands = row.commands if isinstance(row.commands, tuple) else (row.commands,)
    if row.narrowed.model_fields_set and not {"random", "joystick", "uniform"} & set(map(str, commands)):
        yield ("narrowed",), misfit("`narrowed`", "`narrowed` with commands `random`, `joystick` or `uniform` only")
    asked = row.commands if isinstance(row.commands, FixedCommand) else row.narrowed
    place = "commands" if isinstance(row.commands, FixedCommand) else "narrowed"
    for key, value in asked:
        ends = min(getattr(settings.commands, key)), max(getattr(settings.commands, key))
        numbers = cast("tuple[float, ...]", value if isinstance(value, tuple) else () if value is None else (value,))
        for number in numbers:
            yield from within((place, key), number, ends, "the range in section commands")
    for index, push in enumerate(row.pushes):
        if set(commands) == {"stand"} and settings.pushes[push].during != "always":
            yield ("pushes", index), misfit(push, "pushes at any time, where nobody walks")
    if row.draws is not None:
        yield from _draw_problems(settings, name, row)


def _draw_problems(settings: Settings, name: str, row: Scenario) -> Iterator[Problem]:
    """Yield where a scenario that uses the random draws of another one differs in what is drawn."""
    may_differ = {"pushes", "random_torque", "draws"}
    other = settings.scenarios[str(row.draws)]
    if other.draws is not None or row.draws == name:
        yield ("draws",), not_accepted("scenario", row.draws, [k for k, v in settings.scenarios.items() if not v.draws])
    for key, value in other:
        if key not in may_differ and getattr(row, key) != value:
            yield (key,), misfit(f"what differs from scenario {row.draws}", "the same, as it draws alike")


def _set_problems(settings: Settings) -> Iterator[Problem]:
    """Yield training sets that lack a scale, or that are recorded under one name with another one."""
    sets = settings.training_sets
    for name, scale in product(sets, settings.scales):
        if scale not in sets[name].sizes:
            yield ("training_sets", name, "sizes"), misfit(f"no scale {scale}", ", ".join(settings.scales))
        else:
            size = sets[name].sizes[scale]
            place = ("training_sets", name, "sizes", scale, "held_out")
            yield from below(place, size.held_out, size.shards, "the number of shards")
    seen = dict[tuple[str, str], str]()
    for name, row in sets.items():
        first = seen.setdefault((row.scenario, row.level), name)
        if first != name:
            text = misfit(f"{row.scenario} at {row.level}", f"what set {first} does not record already")
            yield ("training_sets", name, "scenario"), text
    for name in FIRST_SETS:
        if name not in sets:
            yield ("training_sets",), misfit(f"no set {name}", f"{', '.join(FIRST_SETS)} among the sets")

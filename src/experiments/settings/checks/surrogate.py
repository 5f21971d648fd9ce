"""What must hold for the surrogate robots, the levels that name them and the fleet that they form."""

from collections.abc import Iterator
from itertools import chain

from pydantic import ValidationError

from experiments.settings.settings import Settings
from mobnet.core.errors import misfit
from mobnet.formats.base import Change
from mobnet.formats.faults import as_many, problems
from mobnet.formats.reading import Place, Problem
from mobnet.settings.surrogate import Surrogate


def surrogate_problems(settings: Settings) -> Iterator[Problem]:
    """Yield what does not fit in drives, levels and the fleet."""
    yield from _drive_problems(settings)
    yield from _level_problems(settings)
    yield from _fleet_problems(settings)
    yield from _number_problems(settings)


def _number_problems(settings: Settings) -> Iterator[Problem]:
    """Yield numbers with which a level or a variant is no surrogate robot."""
    changed: dict[Place, Change] = {}
    for name, row in settings.fleet.variants.items():
        changed["fleet", "variants", name, "numbers"] = row.numbers
    for name, level in settings.levels.items():
        changed["levels", name, "surrogate", "numbers"] = level.surrogate.numbers if level.surrogate else {}
    for place, numbers in changed.items():
        try:
            settings.surrogate.with_numbers(numbers)
        except ValidationError as error:
            for inner, text in problems(error, Surrogate, numbers):
                yield (*place, *inner), text


def _drive_problems(settings: Settings) -> Iterator[Problem]:
    """Yield limbs whose drives are not those of their joints, and motors without a drive."""
    limbs = settings.surrogate.limbs
    groups = settings.robot.groups
    for limb, row in limbs.items():
        for name, values in row:
            place = ("surrogate", "limbs", limb, name)
            what = f"one for each joint of {limb}"
            yield from as_many(place, len(values), len(groups[limb]), what)
    driven = set(chain.from_iterable(groups[limb] for limb in limbs))
    for joint in settings.robot.order.actuated:
        if joint not in driven:
            yield ("surrogate", "limbs"), misfit(f"no drive of {joint}", "limbs with all motors of the robot")
            return


def _level_problems(settings: Settings) -> Iterator[Problem]:
    """Yield levels whose friction acts twice, and labels that no sensor gives."""
    for name, level in settings.levels.items():
        if level.surrogate and "drives" in level.surrogate.parts and level.friction:
            accepted = "[], as the hidden drives have friction of their own"
            yield ("levels", name, "friction"), misfit(list(level.friction), accepted)
        if level.labels == "foot_sensors" and not settings.robot.feet:
            yield ("levels", name, "labels"), misfit(level.labels, "truth, for a robot without feet")


def _fleet_problems(settings: Settings) -> Iterator[Problem]:
    """Yield a fleet that has the name of a level, and training sets without a counterpart."""
    fleet = settings.fleet
    sets = settings.training_sets
    taken = [*settings.levels, *(fleet.level_of(robot, name) for robot in fleet.robots for name in fleet.variants)]
    for place, name in ((("name",), fleet.name), *((("variants", name), name) for name in fleet.variants)):
        if name in taken or (name == fleet.name and place != ("name",)):
            yield ("fleet", *place), misfit(name, "a name that is no level's")
    for name, row in fleet.variants.items():
        if row.parts is not None and "drives" in row.parts and row.friction:
            accepted = "[], as the hidden drives have friction of their own"
            yield ("fleet", "variants", name, "friction"), misfit(list(row.friction), accepted)

    for name, other in fleet.sets.items():
        if sets[other].level not in fleet.levels:
            yield ("fleet", "sets", name), misfit(other, f"a set at one of the levels {', '.join(fleet.levels)}")
    for name, row in sets.items():
        if row.level in fleet.levels and name not in fleet.sets.values():
            yield ("training_sets", name, "level"), misfit(row.level, "a level of one plant, or a set of `fleet.sets`")

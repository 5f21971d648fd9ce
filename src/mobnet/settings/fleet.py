"""The configuration as one robot of the fleet has it."""

from collections.abc import Mapping
from typing import Any

from mobnet.settings.plant import Level
from mobnet.settings.scales import Experiment
from mobnet.settings.settings import Settings
from mobnet.settings.surrogate import Fleet, SurrogateRobot, Variant

FIRST_SEED = 101  # of the networks of the fleet's robots, one for each: their names differ from all others


def levels_of(fleet: Fleet) -> tuple[str, ...]:
    """Return the levels at which each robot of a fleet walks: as it is, and changed."""
    return (fleet.name, *fleet.variants)


def level_of(fleet: Fleet, robot: str, level: str) -> str:
    """Return the level of one robot at a level of its fleet, or at its own."""
    return robot if level in (fleet.name, robot) else f"{robot}_{level}"


def as_robot(settings: Settings, robot: str) -> Settings:
    """Return the configuration of a robot of the fleet: its tests, training sets and experiments, and its variants."""
    fleet, index = settings.fleet, settings.fleet.robots.index(robot)
    following = fleet.robots[(index + 1) % len(fleet.robots)]
    levels = {
        level_of(fleet, robot, name): varied(settings.levels[following if row.other else robot], row)
        for name, row in fleet.variants.items()
    }
    rows = {name: settings.training_sets[other] for name, other in fleet.sets.items()}
    sets = {name: row.model_copy(update={"level": level_of(fleet, robot, row.level)}) for name, row in rows.items()}
    lengths = {**settings.sizes.experiments, **settings.sizes.robots}
    experiments = {
        name: Experiment(epochs=row.epochs, epoch_samples=row.epoch_samples, seeds=(FIRST_SEED + index,))
        for name, row in lengths.items()
    }
    test = settings.sizes.test.model_copy(update={"shards": settings.sizes.fleet_shards or settings.sizes.test.shards})
    sizes = settings.sizes.model_copy(update={"experiments": experiments, "test": test})
    changed: dict[str, Any] = {
        "levels": {**settings.levels, **levels},
        "training_sets": sets,
        "tests": _own(settings, settings.tests, robot),
        "estimated_limbs": _own(settings, settings.estimated_limbs, robot),
        "scales": {settings.scale: sizes},
        "fleet": fleet.model_copy(update={"robots": ()}),
    }
    # not `model_copy`, which would keep what has been worked out of the sections that change
    return Settings.model_construct(**{**dict(settings), **changed})


def varied(level: Level, row: Variant) -> Level:
    """Return the level of a robot with a variant's changes."""
    assert level.surrogate is not None
    named = {"parts": row.parts, "running_s": row.running_s}
    ratios = {"friction_ratio": row.friction_ratio, "constant_ratio": row.constant_ratio}
    given = {key: value for key, value in named.items() if value is not None}
    changed = SurrogateRobot.model_validate({**dict(level.surrogate), **ratios, **given})
    return level.model_copy(update={"surrogate": changed, "friction": row.friction})


def _own(settings: Settings, section: Mapping[str, Mapping[str, Any]], robot: str) -> dict[str, dict[str, Any]]:
    """Return of a section scenario -> level -> names the scenarios that the robot walks, at its own levels.

    What stands at the robot's own level adds to what the whole fleet has.
    """
    fleet, found = settings.fleet, dict[str, dict[str, Any]]()
    for scenario, rows in section.items():
        for name in (*levels_of(fleet), robot):
            if name in rows:
                own = found.setdefault(scenario, {})
                level = level_of(fleet, robot, name)
                own[level] = tuple(dict.fromkeys([*own.get(level, ()), *rows[name]]))
    return found

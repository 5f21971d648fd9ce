"""The configuration as one robot of the fleet has it."""

from typing import Any

from experiments.settings.catalogue import ByTest, Catalogue, Names
from experiments.settings.scales import Experiment
from experiments.settings.trials import experiments_of
from mobnet.settings.surrogate import Fleet, Level, SurrogateRobot, Variant

FIRST_SEED = 101  # of the networks of the fleet's robots, one for each; all other networks have lower ones


def as_robot(catalogue: Catalogue, robot: str) -> Catalogue:
    """Return the configuration of a robot of the fleet: its tests, training sets and experiments, and its variants."""
    settings = catalogue.settings
    fleet = settings.fleet
    index = settings.fleet.robots.index(robot)
    following = fleet.robots[(index + 1) % len(fleet.robots)]
    levels = {
        fleet.level_of(robot, name): varied(settings.levels[following if row.other else robot], row)
        for name, row in fleet.variants.items()
    }
    rows = {name: settings.training_sets[other] for name, other in fleet.sets.items()}
    sets = {name: row.model_copy(update={"level": fleet.level_of(robot, row.level)}) for name, row in rows.items()}
    lengths = {**settings.sizes.experiments, **settings.sizes.robots}
    # What is tried has as many networks on a robot as on the plant, all others one where the scale says no more.
    seeds = {name: settings.sizes.experiments[name].seeds for name in experiments_of(settings.trials)}
    seeds |= {name: row.seeds for name, row in settings.sizes.robots.items() if row.seeds}
    experiments = {
        name: Experiment(
            epochs=row.epochs, epoch_samples=row.epoch_samples, seeds=seeds.get(name, (FIRST_SEED + index,))
        )
        for name, row in lengths.items()
    }
    test = settings.sizes.test.model_copy(update={"shards": settings.sizes.fleet_shards or settings.sizes.test.shards})
    sizes = settings.sizes.model_copy(update={"experiments": experiments, "test": test})
    changed: dict[str, Any] = {
        "levels": {**settings.levels, **levels},
        "training_sets": sets,
        "scales": {settings.scale: sizes},
        "fleet": fleet.model_copy(update={"robots": ()}),
    }
    own = _own(fleet, catalogue.tests, robot), _own(fleet, catalogue.limbs, robot)
    return Catalogue(settings.model_copy(update=changed), own)


def varied(level: Level, row: Variant) -> Level:
    """Return the level of a robot with a variant's changes."""
    assert level.surrogate is not None
    given = {name: value for name, value in row if name in SurrogateRobot.model_fields and value is not None}
    changed = SurrogateRobot.model_validate({**dict(level.surrogate), **given})
    return level.model_copy(update={"surrogate": changed, "friction": row.friction})


def _own(fleet: Fleet, named: ByTest, robot: str) -> ByTest:
    """Return the methods or limbs of the tests that a robot walks, at its own levels.

    What stands at the robot's own level adds to what the whole fleet has.
    """
    found = dict[str, dict[str, Names]]()
    for scenario, rows in named.items():
        for name in (*fleet.levels, robot):
            if name in rows:
                own = found.setdefault(scenario, {})
                level = fleet.level_of(robot, name)
                own[level] = tuple(dict.fromkeys([*own.get(level, ()), *rows[name]]))
    return found

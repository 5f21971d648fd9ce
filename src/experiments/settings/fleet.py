"""The configuration as one robot of the fleet has it."""

from typing import Any

from experiments.settings.catalogue import ByTest, Catalogue, Held, Names
from experiments.settings.scales import Experiment
from experiments.settings.settings import Settings
from experiments.settings.trials import experiments_of
from mobnet.settings.surrogate import Fleet, Level, SurrogateRobot, Variant

FIRST_SEED = 101  # of the networks of the fleet's robots, one for each; all other networks have lower ones
# The first robot's tests have seeds from here on, the next robot's so many more: no two robots walk the same.
OWN_TESTS = 10_000


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
    plant = settings.sizes.test
    first_seed = OWN_TESTS * (index + 1) + plant.first_seed
    shards = settings.sizes.fleet_shards or plant.shards
    test = plant.model_copy(update={"first_seed": first_seed, "shards": shards})
    sizes = settings.sizes.model_copy(update={"experiments": experiments, "test": test})
    changed: dict[str, Any] = {
        "levels": {**settings.levels, **levels},
        "training_sets": sets,
        "scales": {settings.scale: sizes},
        "fleet": fleet.model_copy(update={"robots": ()}),
    }
    if not is_whole(settings, robot):
        # What is fitted learns from the walks of its legs alone.
        methods = settings.methods.items()
        fits = {name: row.model_copy(update={"fitted": (fleet.leg,)}) for name, row in methods if row.fitted}
        changed["methods"] = {**settings.methods, **fits}
        tests_and_limbs = _own_of_a_leg(fleet, catalogue, robot)
    else:
        tests_and_limbs = _own(fleet, catalogue, robot)
    return Catalogue(settings.model_copy(update=changed), tests_and_limbs)


def is_whole(settings: Settings, robot: str) -> bool:
    """Return whether a robot walks all tests at the chosen scale, and not those of a leg alone."""
    whole = settings.sizes.fleet_whole
    return whole is None or settings.fleet.robots.index(robot) < whole


def varied(level: Level, row: Variant) -> Level:
    """Return the level of a robot with a variant's changes."""
    assert level.surrogate is not None
    given = {name: value for name, value in row if name in SurrogateRobot.model_fields and value is not None}
    changed = SurrogateRobot.model_validate({**dict(level.surrogate), **given})
    return level.model_copy(update={"surrogate": changed, "friction": row.friction})


def _own(fleet: Fleet, catalogue: Catalogue, robot: str) -> tuple[ByTest, Held]:
    """Return the methods of the tests that a robot walks, at its own levels, and the limbs of each of them.

    What stands at the robot's own level adds to what the whole fleet has.
    """
    tests = dict[str, dict[str, Names]]()
    limbs = dict[tuple[str, str, str], Names]()
    for scenario, rows in catalogue.tests.items():
        for name in (*fleet.levels, robot):
            level = fleet.level_of(robot, name)
            for method in rows.get(name, ()):
                by_level = tests.setdefault(scenario, {})
                by_level[level] = tuple(dict.fromkeys([*by_level.get(level, ()), method]))
                limbs_of_method = (*limbs.get((scenario, level, method), ()), *catalogue.limbs[scenario, name, method])
                limbs[scenario, level, method] = tuple(dict.fromkeys(limbs_of_method))
    return tests, limbs


def _own_of_a_leg(fleet: Fleet, catalogue: Catalogue, robot: str) -> tuple[ByTest, Held]:
    """Return the methods and limbs of the tests of a robot that walks those of one leg alone."""
    tests = dict[str, dict[str, Names]]()
    limbs = dict[tuple[str, str, str], Names]()
    for scenario in fleet.leg_tests:
        named = catalogue.tests.get(scenario, {}).get(fleet.name, ())
        tests[scenario] = {robot: tuple(name for name in named if name in fleet.leg_methods)}
        for method in tests[scenario][robot]:
            limbs[scenario, robot, method] = (fleet.leg,)
    return tests, limbs

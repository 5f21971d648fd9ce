"""What the library reads of the configuration, without the experiments of the paper: no scale, no table, no claim."""

from functools import cache
from pathlib import Path

from mobnet.estimation.recipe import Recipe
from mobnet.formats.reading import Document
from mobnet.learning.precision import in_precision, of_processor
from mobnet.settings.data import (
    Commands,
    Motion,
    Obstacle,
    Push,
    RandomTorque,
    RecordingSettings,
    Scenario,
    Terrain,
    TrainingSet,
)
from mobnet.settings.lab import Lab
from mobnet.settings.methods import Method
from mobnet.settings.networks import Learning, Network, Training
from mobnet.settings.reaction import Reaction
from mobnet.settings.surrogate import Level, Surrogate
from mobnet.settings.walking import Walking, WalkSettings

ROOT = Path(__file__).parents[1]
FILES = (
    "config", "plant", "surrogate", "walking", "data", "networks", "methods", "detection", "reaction", "robotlog",
    "motion",
)  # fmt: skip
SHORT = {"batch_size": 4, "stream_s": 4.0}  # learning of a few seconds


class LibrarySettings(Lab):
    """The sections of a lab, and those from which it walks, learns and reacts in simulation."""

    levels: dict[str, Level]
    surrogate: Surrogate
    walking: Walking
    terrain: Terrain
    commands: Commands
    random_torque: RandomTorque
    motions: dict[str, Motion]
    pushes: dict[str, Push]
    obstacles: dict[str, Obstacle]
    scenarios: dict[str, Scenario]
    training_sets: dict[str, TrainingSet]
    recording: RecordingSettings
    methods: dict[str, Method]
    reaction: Reaction

    @property
    def layout(self):
        return self.robot.layout


@cache
def library_settings():
    """Return the repository's configuration, with this machine's number format."""
    values = {}
    for name in FILES:
        values |= Document(ROOT / "configs" / f"{name}.yaml").values
    values["robot"] = Document(ROOT / values["robot"]).values
    settings = LibrarySettings.model_validate({name: values[name] for name in LibrarySettings.model_fields})
    return settings.model_copy(update={"learning": in_precision(settings.learning, of_processor())})


def network_of(settings, method, limb):
    """Return a network with the changes of the method that owns it."""
    owner = settings.methods[method].networks_of.get(limb, method)
    parts = vars(settings.robot.networks[limb]), vars(settings.networks[limb]), settings.methods[owner].network
    return Network.model_validate({key: value for part in parts for key, value in part.items()})


def training_of(settings, method, limb):
    """Return a short training of a method's network."""
    row, network = settings.methods[method], network_of(settings, method, limb)
    return Training(
        method=method,
        limb=limb,
        target=row.target,
        network=network,
        learning=Learning.model_validate({**vars(settings.learning), **SHORT, **row.learning}),
        epochs=2,
        epoch_samples=8000,
        held_out=settings.training_sets[network.data].sizes["smoke"].held_out,
    )


def recipes(settings, all_methods):
    """Return a function of a method's name, its level, its files and other methods that makes its recipe."""

    def recipe(name, level="all_uncertainty", **changes):
        methods = changes.pop("methods", all_methods)
        observing = settings.levels[level].nominal_mass_ratio, settings.plant.gravity_m_s2, settings.observer
        return Recipe(name, methods, settings.robot, *observing, settings.rates.data_hz, **changes)

    return recipe


def walk_settings(settings, scenario, level):
    """Return what a walk takes: terrains, pushes and obstacles that the scenario names, gait and gains of the level."""
    row, walking, chosen = settings.scenarios[scenario], settings.walking, settings.levels[level].surrogate
    if chosen:
        gait = {name: value for name, value in chosen.gait if value is not None}
        row = row.model_copy(update={"narrowed": row.narrowed.model_copy(update=gait)})
        gains = {
            name: tuple(chosen.gain_ratio * gain for gain in getattr(walking, name))
            for name in ("leg_stiffness_nm_rad", "leg_damping_nms_rad")
        }
        walking = walking.model_copy(update=gains)
    own = {
        "scenario_name": scenario,
        "scenario": row,
        "walking": walking,
        "level_name": level,
        "level": settings.levels[level],
        "surrogate": settings.surrogate if chosen else None,
        "terrain": Terrain(**{name: getattr(settings.terrain, name) for name in row.terrain}),
        "pushes": {name: settings.pushes[name] for name in row.pushes},
        "obstacles": {name: settings.obstacles[name] for name in row.obstacles},
    }
    shared = WalkSettings.model_fields.keys() - own
    return WalkSettings(**own, **{name: getattr(settings, name) for name in shared})

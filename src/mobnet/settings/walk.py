"""What a simulated walk takes of the configuration."""

from mobnet.settings.base import Section
from mobnet.settings.data import Commands, Obstacle, Push, RandomTorque, RecordingSettings, Scenario, Terrain
from mobnet.settings.plant import Plant, Rates
from mobnet.settings.robot import RobotTable
from mobnet.settings.surrogate import Level, Surrogate
from mobnet.settings.walking import Walking


class WalkSettings(Section):
    """A scenario at a level, with the terrains and pushes that it names and no others; recordings draw by its name."""

    seed: int
    robot: RobotTable
    rates: Rates
    plant: Plant
    walking: Walking
    commands: Commands
    random_torque: RandomTorque
    recording: RecordingSettings
    scenario_name: str
    scenario: Scenario
    level_name: str
    level: Level
    surrogate: Surrogate | None
    terrain: Terrain
    pushes: dict[str, Push]
    obstacles: dict[str, Obstacle]

"""What a walk takes of the configuration; other jobs take whole sections."""

from mobnet.settings.base import Section
from mobnet.settings.data import Commands, Push, RandomTorque, RecordingSettings, Scenario, Terrain
from mobnet.settings.plant import Level, Plant, Rates
from mobnet.settings.robot import RobotTable
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
    terrain: Terrain
    pushes: dict[str, Push]

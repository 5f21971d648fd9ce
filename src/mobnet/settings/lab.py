"""What a lab's commands take of the configuration: the robot, the observer, networks, detection and logs.

A fault in what the paper's experiments alone need, such as a claim or a figure, does not stop them.
"""

from collections.abc import Mapping
from itertools import chain
from pathlib import Path
from typing import Annotated

from pydantic import Field

from mobnet.core.files import files_like
from mobnet.core.place import CONFIGS
from mobnet.formats.base import Index, RobotNetworkName, Section
from mobnet.formats.checks.robot import robot_problems
from mobnet.formats.faults import refuse_faults, validated
from mobnet.formats.reading import Document, Place
from mobnet.formats.robot import RobotTable
from mobnet.settings.detection import ContactPoint, Detection
from mobnet.settings.free_motion import FreeMotion
from mobnet.settings.methods import ObserverSettings
from mobnet.settings.networks import Learning, NetworkRow
from mobnet.settings.plant import Plant, Rates
from mobnet.settings.robotlog import RobotLog

FILES: Mapping[str, tuple[str, ...]] = {  # file -> the sections of it that a lab takes
    "config": ("seed", "robot"),
    "plant": ("rates", "plant"),
    "networks": ("networks", "learning"),
    "methods": ("observer",),
    "detection": ("detection", "contact_point"),
    "robotlog": ("robotlog",),
    "motion": ("free_motion",),
}


class Lab(Section):
    """Numbers that have no part in an experiment's plan; `seed` is the root of all random numbers."""

    seed: Index
    rates: Rates
    plant: Plant
    observer: ObserverSettings
    networks: Annotated[dict[RobotNetworkName, NetworkRow], Field(min_length=1)]
    learning: Learning
    detection: Detection
    contact_point: ContactPoint
    robotlog: RobotLog
    free_motion: FreeMotion
    robot: RobotTable


def load_lab(folder: Path = CONFIGS) -> Lab:
    """Read and check what a lab takes of the configuration of a folder.

    Raises:
        ConfigError: a file, a key or a value is not accepted; one line for each of them.
    """
    documents = {name: Document(folder / f"{name}.yaml") for name in FILES}
    refuse_faults(chain.from_iterable(document.faults for document in documents.values()))
    homes = dict[str, Document]()
    for name, sections in FILES.items():
        homes |= dict.fromkeys(sections, documents[name])
    values = {section: home.values[section] for section, home in homes.items() if section in home.values}
    robot = folder.parent / str(values.get("robot"))
    config = homes["robot"]
    if not robot.is_file():
        text = f"{values.get('robot')!r} is not accepted; accepted: the path of a YAML file{files_like(robot)}"
        refuse_faults([config.told(("robot",), text)])
    homes["robot"] = Document(robot)
    refuse_faults(homes["robot"].faults)
    values["robot"] = homes["robot"].values

    def told(place: Place, text: str) -> str:
        section = str(place[0]) if place else ""
        return homes.get(section, config).told(place[1:] if section == "robot" else place, text)

    lab = validated(Lab, values, values, told)
    refuse_faults(homes["robot"].told(place, text) for place, text in robot_problems(lab.robot))
    return lab

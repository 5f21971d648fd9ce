"""A section from a file of its own, such as a robot's table, the thresholds of a limb or the map of a log."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, TypeVar

from mobnet.formats.base import Section
from mobnet.formats.checks.robot import robot_problems
from mobnet.formats.faults import refuse_faults, validated
from mobnet.formats.reading import Document, Place
from mobnet.formats.robot import RobotTable

Kind = TypeVar("Kind", bound=Section)


def load_section(path: Path, kind: type[Kind], key: str = "") -> Kind:
    """Read one section from a file of its own, such as a robot's table, or what stands below a key of the file.

    Raises:
        ConfigError: the file, a key or a value is not accepted; one line for each of them.
    """
    document = Document(path)
    refuse_faults(document.faults)
    values: Mapping[str, Any] = document.values.get(key, {}) if key else document.values
    above: Place = (key,) if key else ()
    section = validated(kind, values, values, lambda place, text: document.told((*above, *place), text))
    if isinstance(section, RobotTable):
        refuse_faults(document.told(place, text) for place, text in robot_problems(section))
    return section

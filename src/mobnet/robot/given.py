"""The robot that a user names by a file; no job of the workflow takes one."""

from pathlib import Path

from mobnet.core.files import descriptor_of
from mobnet.core.place import check_extra
from mobnet.formats.loading import load_section
from mobnet.formats.robot import RobotTable
from mobnet.robot.description import RobotDescription, describe

FILES = (".urdf", ".xml", ".mjcf")  # of robots that no table describes yet; gzip may have packed them


def given_table(path: Path | None, usual: RobotTable) -> RobotTable:
    """Return the table of a file, or the usual one where none is given.

    A URDF or MJCF file is read as `mobnet robot` makes a table of it without further words.

    Raises:
        ConfigError: the file cannot be read, or is no table of a robot.
        DataError: the file is no robot, or a table cannot hold it.
    """
    if path is None:
        return usual
    if not is_robot_file(path):
        return load_section(path, RobotTable)
    check_extra("simulate")
    from mobnet.robot.import_table import read_table  # MuJoCo, which comes with an extra

    table, _ = read_table(path)
    return table


def given_robot(path: Path | None, usual: RobotTable) -> RobotDescription:
    """Return the robot of a file as `given_table` does its table, with notes of what the file does not say."""
    return describe(usual) if path is None else robot_of_file(path)


def robot_of_file(path: Path) -> RobotDescription:
    """Return the robot of a table, or of a URDF or MJCF file, with notes of what the file does not say.

    Raises:
        ConfigError: the file cannot be read, or is no table of a robot.
        DataError: the file is no robot, or a table cannot hold it.
    """
    if not is_robot_file(path):
        return describe(load_section(path, RobotTable))
    check_extra("simulate")
    from mobnet.robot.import_table import read_robot

    return read_robot(path)


def is_robot_file(path: Path) -> bool:
    """Return whether a path is that of a URDF or MJCF file; standard input and pipes hold one."""
    return descriptor_of(path) is not None or path.name.lower().removesuffix(".gz").endswith(FILES)

"""The words of `./reproduce identify`. Standard library only: help is printed before there is an environment."""

import argparse
from pathlib import Path

from mobnet.core.place import command


def identify_parser() -> argparse.ArgumentParser:
    """Return the parser of the command's options."""
    parser = argparse.ArgumentParser(
        prog=command("identify"),
        description="Find friction, rotor inertia and constant error of each joint in logs of free motion, in which "
        "nothing touches the robot, and write them into a new table. The observer then takes them into account "
        "(docs/identify.md).",
    )
    parser.add_argument(
        "logs",
        type=Path,
        nargs="+",
        metavar="FOLDER",
        help=f"what `{command('observe')}` wrote, or a log as it reads it",
    )
    parser.add_argument("--robot", type=Path, help="table of the robot (default: that of configs)")
    parser.add_argument("--map", type=Path, help="what the columns of logs mean, where logs are given")
    parser.add_argument(
        "--scale", action="store_true", help="also find the factor of each motor's torque, such as a torque constant"
    )
    parser.add_argument(
        "--load",
        action="store_true",
        help="also find dry friction in proportion to the motor's torque; it hides that share of a push which brakes a "
        "joint",
    )
    parser.add_argument(
        "--payload", metavar="BODY", help="also find mass and centre of what this body carries, and the table lacks"
    )
    parser.add_argument("--out", type=Path, metavar="TABLE", help="the new table (default: the robot's name, here)")
    parser.add_argument("--force", action="store_true", help="replace a table that is there")
    return parser

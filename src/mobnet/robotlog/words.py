"""The words of `./reproduce observe`. Standard library only: help is printed before there is an environment."""

import argparse
from pathlib import Path

from mobnet.core.place import command


def observe_parser() -> argparse.ArgumentParser:
    """Return the parser of the command's options."""
    parser = argparse.ArgumentParser(
        prog=command("observe"),
        description="Make a recording and the momentum observer's residual of a robot's log, with a plot of it, and "
        "say what looks wrong with the log.",
        epilog="LOG is a text with a separator, .parquet, .h5, .mat, .npz, .mcap, .bag, .db3, or a folder that "
        "`ros2 bag` wrote (docs/robots.md).",
    )
    parser.add_argument("log", type=Path, metavar="LOG", help="log of a robot")
    parser.add_argument("--robot", type=Path, help="table of the robot (default: that of configs)")
    parser.add_argument("--map", type=Path, help="what its columns mean (default: columns named as in docs/data.md)")
    parser.add_argument(
        "--torque",
        choices=("sample", "mean"),
        help="whether torques are samples at the ticks or means over the intervals before them (default: the map's)",
    )
    parser.add_argument("--gain", type=float, metavar="K", help="gain of the observer [1/s] (default: that of configs)")
    add_wrench(parser)
    parser.add_argument("--out", type=Path, help="folder of what is made (default: LOG's name with _observed, here)")
    return parser


def add_wrench(parser: argparse.ArgumentParser) -> None:
    """Add the option by which `observe` and `detect` also write wrenches."""
    parser.add_argument(
        "--wrench",
        action="append",
        default=[],
        metavar="NAME",
        help="also write the external wrench at a point or body of the table (repeat for several)",
    )

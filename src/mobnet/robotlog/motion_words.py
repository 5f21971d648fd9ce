"""The words of `./reproduce motion`. Standard library only: help is printed before there is an environment."""

import argparse
from pathlib import Path

from mobnet.core.place import command


def motion_parser() -> argparse.ArgumentParser:
    """Return the parser of the command's options."""
    parser = argparse.ArgumentParser(
        prog=command("motion"),
        description="Simulate a robot of a table whose joints move at random while it does not walk, and write its log "
        f"with the columns that {command('observe')} takes without a map (docs/robots.md).",
    )
    parser.add_argument("--robot", type=Path, help="table of the robot (default: that of configs)")
    parser.add_argument("--minutes", type=float, default=1.0, help="how long it moves (default: %(default)s)")
    parser.add_argument("--seed", type=int, default=1, help="of motion, pushes and noise (default: %(default)s)")
    parser.add_argument(
        "--pushes",
        action="store_true",
        help="forces on its links; the log then has tau_ext, the truth, as that of a floating base always has",
    )
    parser.add_argument(
        "--ideal", action="store_true", help="without friction, errors of masses and motors, and noise of sensors"
    )
    parser.add_argument(
        "--out", type=Path, default=Path("motion.csv"), help="the log, .csv or .parquet (default: %(default)s)"
    )
    return parser

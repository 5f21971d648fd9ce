"""The words of `./reproduce robot`. Standard library only: help is printed before there is an environment."""

import argparse
from pathlib import Path

from mobnet.core.place import command


def import_parser() -> argparse.ArgumentParser:
    """Return the parser of the command's options."""
    parser = argparse.ArgumentParser(
        prog=command("robot"),
        description="Make the table of a robot from its URDF or MJCF file, say what the file lacks, and compare mass "
        "matrix and bias with MuJoCo's and Pinocchio's own reading of the file.",
    )
    parser.add_argument(
        "file",
        type=Path,
        metavar="FILE",
        help="URDF or MJCF of a robot; it needs no meshes, except bodies of a MJCF without an <inertial>",
    )
    parser.add_argument(
        "--base", metavar="KIND", help="fixed or floating (default: floating where the file has a free joint)"
    )
    parser.add_argument("--out", type=Path, help="the table (default: FILE's name with .yaml, here)")
    parser.add_argument("--force", action="store_true", help="replace a table that exists")
    parser.add_argument(
        "--torque-limit", type=float, default=100.0, help="of joints without one [N m] (default: %(default)s)"
    )
    parser.add_argument(
        "--speed-limit", type=float, default=10.0, help="of joints without one [rad/s] (default: %(default)s)"
    )
    parser.add_argument(
        "--armature",
        type=float,
        default=0.0,
        help="rotor inertia of joints without one, behind the gear [kg m^2] (default: %(default)s)",
    )
    parser.add_argument(
        "--lock",
        action="append",
        default=[],
        metavar="JOINT=ANGLE",
        help="weld a joint that the log does not have, such as one of a gripper, at an angle [rad], JOINT alone at "
        "zero; may be given several times",
    )
    return parser

"""The words of `./reproduce export`. Standard library only: help is printed before there is an environment."""

import argparse
from pathlib import Path

from mobnet.core.place import command


def export_parser() -> argparse.ArgumentParser:
    """Return the parser of the command's options."""
    parser = argparse.ArgumentParser(
        prog=command("export"),
        description="Write trained networks as ONNX files, one for each limb, with what a program that runs them must "
        "know: names, units and order of inputs and outputs, rate, observer, thresholds. Where all networks are of the "
        "cells GRU and constant, also write model.bin, which the C library in src/runtime runs with the observer.",
        epilog="docs/runtime.md says how these files are used from Python, C and ROS 2.",
    )
    parser.add_argument("network", type=Path, nargs="+", metavar="NET", help="folder of a trained network")
    parser.add_argument("--robot", type=Path, help="table of the robot (default: that of configs)")
    parser.add_argument(
        "--thresholds",
        type=Path,
        action="append",
        default=[],
        metavar="FILE",
        help=f"thresholds of a limb, as {command('calibrate')} writes them; may be given again",
    )
    parser.add_argument("--rate", type=float, metavar="HZ", help="samples per second, where the training noted none")
    parser.add_argument(
        "--gain", type=float, metavar="K", help="gain of the observer [1/s], where the training noted none"
    )
    parser.add_argument(
        "--torque",
        choices=("sample", "mean"),
        help="whether torques are samples at the ticks or means over the intervals before them, "
        "where the training noted neither",
    )
    parser.add_argument("--out", type=Path, required=True, help="folder of what is made")
    return parser

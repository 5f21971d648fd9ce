"""The words of `./reproduce calibrate`. Standard library only: help is printed before there is an environment."""

import argparse
from pathlib import Path


def calibrate_parser() -> argparse.ArgumentParser:
    """Return the parser of the calibrator's options."""
    parser = argparse.ArgumentParser(
        prog="./reproduce calibrate",
        description="Print thresholds for a wanted rate of false alarms, from walking that nothing pushes.",
        epilog="Files are .parquet with their .json (docs/robots.md); recordings and estimates come in one order.",
    )
    parser.add_argument("--recording", type=Path, action="append", required=True, help="walking; may be given again")
    parser.add_argument("--estimate", type=Path, action="append", required=True, help="its estimate by any method")
    parser.add_argument("--leg", default="LL", help="limb of the robot (default: %(default)s)")
    parser.add_argument("--rate", type=float, default=1.0, help="wanted false alarms in an hour (default: %(default)s)")
    parser.add_argument("--robot", type=Path, help="table of the robot (default: that of configs)")
    return parser

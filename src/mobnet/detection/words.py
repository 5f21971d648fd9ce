"""The words of `./reproduce calibrate`. Standard library only: help is printed before there is an environment."""

import argparse
from pathlib import Path

from mobnet.core.place import command

SIGNALS = ("mean", "std", "ratio")


def calibrate_parser() -> argparse.ArgumentParser:
    """Return the parser of the calibrator's options."""
    parser = argparse.ArgumentParser(
        prog=command("calibrate"),
        description="Print thresholds for a wanted rate of false alarms, from recordings that nothing pushes: of a leg "
        "from its swings, of any other limb from windows of time.",
        epilog="In place of folders, --recording with --estimate takes arrays, .parquet with their .json "
        "(docs/robots.md), in one order.",
    )
    parser.add_argument("folders", type=Path, nargs="*", metavar="FOLDER", help=f"what `{command('observe')}` wrote")
    parser.add_argument("--network", type=Path, metavar="NET", help="what `learn` wrote (default: the observer alone)")
    usual = "mean; with --network what finds most planted pushes, of the network or of the observer"
    parser.add_argument("--signal", help=f"{', '.join(SIGNALS)} of the estimate (default: {usual})")
    parser.add_argument("--recording", type=Path, action="append", default=[], help="recording; may be given again")
    parser.add_argument("--estimate", type=Path, action="append", default=[], help="its estimate by any method")
    parser.add_argument("--limb", "--leg", help="limb of the robot (default: the network's, the only one, or a leg)")
    parser.add_argument("--rate", type=float, default=1.0, help="wanted false alarms in an hour (default: %(default)s)")
    parser.add_argument("--robot", type=Path, help="table of the robot (default: that of configs)")
    parser.add_argument("--out", type=Path, metavar="FILE", help="write the thresholds there, YAML (default: nowhere)")
    return parser

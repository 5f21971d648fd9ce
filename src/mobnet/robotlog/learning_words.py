"""The words of `./reproduce learn` and `./reproduce detect`. Standard library only: help needs no environment."""

import argparse
from pathlib import Path

from mobnet.core.place import command
from mobnet.robotlog.words import add_wrench

LABELS = {
    "free": "nothing touched the limb: its external torque is zero",
    "feet": "sensors in the feet",
    "tool": "a sensor at the end effector, `tool` in the map of the log",
}


def learn_parser() -> argparse.ArgumentParser:
    """Return the parser of the options of `learn`."""
    parser = argparse.ArgumentParser(
        prog=command("learn"),
        description="Train a network that predicts what the observer's model gets wrong of a limb, on logs that "
        f"`{command('observe')}` made recordings of, and try it on the end of the logs, which it never sees. The same "
        "words go on with a training that was stopped.",
        epilog=f"labels, what is known of the external torque: {'; '.join(f'{k}: {v}' for k, v in LABELS.items())}.",
    )
    parser.add_argument("folders", type=Path, nargs="+", metavar="FOLDER", help=f"what `{command('observe')}` wrote")
    parser.add_argument("--robot", type=Path, help="table of the robot (default: that of configs)")
    parser.add_argument("--limb", help="limb of the robot (default: its only one)")
    parser.add_argument("--labels", default="free", help=f"{', '.join(LABELS)} (default: %(default)s)")
    parser.add_argument("--epochs", type=int, metavar="N", help="how long it learns (default: that of configs)")
    parser.add_argument("--out", type=Path, metavar="NET", help="folder of the network (default: LIMB_net, here)")
    parser.add_argument("--force", action="store_true", help="replace a network that was made in another way")
    return parser


def detect_parser() -> argparse.ArgumentParser:
    """Return the parser of the options of `detect`."""
    parser = argparse.ArgumentParser(
        prog=command("detect"),
        description="Estimate the external torque of a limb in a log, and write when something pushes it: flags.csv, "
        "the estimate with its standard deviation, and a plot of torque, thresholds and flags.",
    )
    parser.add_argument("log", type=Path, metavar="LOG", help=f"log of a robot, as `{command('observe')}` reads it")
    parser.add_argument("--robot", type=Path, help="table of the robot (default: that of configs)")
    parser.add_argument("--map", type=Path, help="what its columns mean (default: columns named as in docs/data.md)")
    parser.add_argument("--network", type=Path, metavar="NET", help="what `learn` wrote (default: the observer alone)")
    parser.add_argument("--thresholds", type=Path, required=True, metavar="FILE", help="what `calibrate --out` wrote")
    add_wrench(parser)
    parser.add_argument("--out", type=Path, help="folder of what is made (default: LOG's name with _detected, here)")
    return parser

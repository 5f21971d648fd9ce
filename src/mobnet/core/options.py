"""The words of the commands of a lab. Standard library only: help is printed before there is an environment."""

import argparse
from collections.abc import Iterator
from pathlib import Path

from mobnet.core.files import STDIN, descriptor_of, files_like
from mobnet.core.place import command

LABELS = {
    "free": "nothing touched the limb: its external torque is zero",
    "feet": "sensors in the feet",
    "tool": "a sensor at the end effector, `tool` in the map of the log",
}
SIGNALS = ("mean", "std", "ratio")
MCAP = ".mcap"  # ending of what Foxglove opens
# Of a joint for which a robot's file or model has no limit or no rotor.
TORQUE_LIMIT_NM = 100.0
SPEED_LIMIT_RAD_S = 10.0
ARMATURE_KG_M2 = 0.0
FROM_STDIN = ("robot", "file")  # words that may be `-`: files of robots


def observe_parser() -> argparse.ArgumentParser:
    """Return the parser of the command's options."""
    parser = argparse.ArgumentParser(
        prog=command("observe"),
        description="Make a recording and the momentum observer's residual of a robot's log, with a plot of it, and "
        "say what looks wrong with the log.",
        epilog="LOG is a text with a separator, .parquet, .h5, .mat, .npz, .mcap, .bag, .db3, or a folder that "
        "`ros2 bag` wrote (docs/log_formats.md).",
    )
    parser.add_argument("log", type=log_path, metavar="LOG", help="log of a robot; - is standard input")
    add_robot(parser)
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


def log_path(word: str) -> Path:
    """Return the file of a log that a word names; `-` is standard input."""
    return STDIN if word == "-" else Path(word)


def add_robot(parser: argparse.ArgumentParser) -> None:
    """Add the option that names the file of a robot."""
    parser.add_argument(
        "--robot",
        type=Path,
        help="table of the robot, or its URDF or MJCF file; - is standard input (default: the table of configs)",
    )


def add_wrench(parser: argparse.ArgumentParser) -> None:
    """Add the option by which `observe` and `detect` also write wrenches."""
    parser.add_argument(
        "--wrench",
        action="append",
        default=[],
        metavar="NAME",
        help="also write the external wrench at a point or body of the table (repeat for several)",
    )


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
    add_robot(parser)
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
    parser.add_argument("log", type=log_path, metavar="LOG", help=f"log of a robot, as `{command('observe')}` reads it")
    add_robot(parser)
    parser.add_argument("--map", type=Path, help="what its columns mean (default: columns named as in docs/data.md)")
    parser.add_argument("--network", type=Path, metavar="NET", help="what `learn` wrote (default: the observer alone)")
    parser.add_argument("--thresholds", type=Path, required=True, metavar="FILE", help="what `calibrate --out` wrote")
    add_wrench(parser)
    parser.add_argument(
        "--out",
        type=Path,
        help="folder of what is made (default: LOG's name with _detected, here), or NAME.mcap: one file for Foxglove",
    )
    return parser


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
    add_robot(parser)
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


def motion_parser() -> argparse.ArgumentParser:
    """Return the parser of the command's options."""
    parser = argparse.ArgumentParser(
        prog=command("motion"),
        description="Simulate a robot of a table whose joints move at random while it does not walk, and write its log "
        f"with the columns that {command('observe')} takes without a map (docs/logs.md).",
    )
    add_robot(parser)
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
        "--torque-limit", type=float, default=TORQUE_LIMIT_NM, help="of joints without one [N m] (default: %(default)s)"
    )
    parser.add_argument(
        "--speed-limit",
        type=float,
        default=SPEED_LIMIT_RAD_S,
        help="of joints without one [rad/s] (default: %(default)s)",
    )
    parser.add_argument(
        "--armature",
        type=float,
        default=ARMATURE_KG_M2,
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


def calibrate_parser() -> argparse.ArgumentParser:
    """Return the parser of the calibrator's options."""
    parser = argparse.ArgumentParser(
        prog=command("calibrate"),
        description="Print thresholds for a wanted rate of false alarms, from recordings that nothing pushes: of a leg "
        "from its swings, of any other limb from windows of time.",
        epilog="In place of folders, --recording with --estimate takes arrays, .parquet with their .json "
        "(docs/log_formats.md), in one order.",
    )
    parser.add_argument("folders", type=Path, nargs="*", metavar="FOLDER", help=f"what `{command('observe')}` wrote")
    parser.add_argument("--network", type=Path, metavar="NET", help="what `learn` wrote (default: the observer alone)")
    usual = "mean; with --network what finds most planted pushes, of the network or of the observer"
    parser.add_argument("--signal", help=f"{', '.join(SIGNALS)} of the estimate (default: {usual})")
    parser.add_argument("--recording", type=Path, action="append", default=[], help="recording; may be given again")
    parser.add_argument("--estimate", type=Path, action="append", default=[], help="its estimate by any method")
    parser.add_argument("--limb", "--leg", help="limb of the robot (default: the network's, the only one, or a leg)")
    parser.add_argument("--rate", type=float, default=1.0, help="wanted false alarms in an hour (default: %(default)s)")
    add_robot(parser)
    parser.add_argument("--out", type=Path, metavar="FILE", help="write the thresholds there, YAML (default: nowhere)")
    return parser


def export_parser() -> argparse.ArgumentParser:
    """Return the parser of the command's options."""
    parser = argparse.ArgumentParser(
        prog=command("export"),
        description="Write trained networks as ONNX files, one for each limb, with what a program that runs them must "
        "know: names, units and order of inputs and outputs, rate, observer, thresholds. Where all networks are of the "
        "cells GRU and constant, also write model.bin, which the C library in src/runtime runs with the observer. "
        "Without a network that is the observer alone, with the thresholds that are given.",
        epilog="docs/runtime.md says how these files are used from Python, C and ROS 2.",
    )
    parser.add_argument(
        "network", type=Path, nargs="*", metavar="NET", help="folder of a trained network (default: the observer alone)"
    )
    add_robot(parser)
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


def missing_input(options: argparse.Namespace) -> str | None:
    """Return a line about the first file or folder that a command gets and that is not there; None if all are."""
    given = list(_inputs(options))
    readers = [name for name, path in given if descriptor_of(path) == 0]
    if len(readers) > 1:
        return f"{' and '.join(readers)}: standard input for both is not accepted; accepted: a file for one of them"
    for name, path in given:
        is_stdin = name in readers and name in FROM_STDIN
        if not is_stdin and not _is_there(path):
            return f"{path}: no such file or folder{files_like(path)}"
    return None


def _inputs(options: argparse.Namespace) -> Iterator[tuple[str, Path]]:
    """Yield the names of words with the paths that they give, but for what a command makes."""
    for name, value in vars(options).items():
        values = value if isinstance(value, list) else [value]
        paths = [path for path in values if isinstance(path, Path)]
        if name != "out":
            yield from ((name, path) for path in paths)


def _is_there(path: Path) -> bool:
    """Return whether a file or folder is there; arrays may be named without their ending."""
    try:
        return path.exists() or path.with_name(f"{path.name}.parquet").exists()
    except (OSError, ValueError):  # a name that the file system does not take: the command says so itself
        return True

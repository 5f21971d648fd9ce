"""The commands of a lab: `mobnet observe LOG ...`, which in a checkout is `./reproduce observe LOG ...`.

What each one imports stands in its module, so that help is printed at once, and an extra that a command needs and that
is not installed is named in one line.
"""

import argparse
import sys
from collections.abc import Callable, Sequence
from typing import NamedTuple

from mobnet.core.errors import ConfigError, unknown_command
from mobnet.core.options import (
    calibrate_parser,
    detect_parser,
    export_parser,
    identify_parser,
    import_parser,
    learn_parser,
    missing_input,
    motion_parser,
    observe_parser,
)
from mobnet.core.place import PROGRAM, version, with_extra


class Command(NamedTuple):
    """A command: what it does, in a line; the parser of its options; and the module whose `main` runs it."""

    says: str
    parser: Callable[[], argparse.ArgumentParser]
    module: str


COMMANDS = {
    "robot": Command("make a robot's table from its URDF or MJCF file", import_parser, "mobnet.robot.import_table"),
    "motion": Command(
        "simulate the log of a robot of a table that moves without walking", motion_parser, "mobnet.robotlog.motion"
    ),
    "observe": Command(
        "make the residual of a robot's own log, and say what looks wrong with it",
        observe_parser,
        "mobnet.robotlog.observe",
    ),
    "identify": Command(
        "find friction and rotor inertia in logs of free motion, for the robot's table",
        identify_parser,
        "mobnet.robotlog.identify",
    ),
    "learn": Command(
        "train a network on a robot's own logs, and try it on their end", learn_parser, "mobnet.robotlog.learn"
    ),
    "calibrate": Command(
        "print thresholds of detection for a wanted rate of false alarms",
        calibrate_parser,
        "mobnet.detection.calibrate",
    ),
    "detect": Command(
        "write when something pushes a limb in a robot's own log", detect_parser, "mobnet.robotlog.detect"
    ),
    "export": Command(
        "write trained networks as ONNX files that run without this project", export_parser, "mobnet.export.export"
    ),
}


def demo_parser() -> argparse.ArgumentParser:
    """Return the parser of `mobnet demo`."""
    return argparse.ArgumentParser(
        prog="mobnet demo",
        description="Show a push on a walking robot as the observer and a trained network estimate it; both come with "
        "the package.",
    )


def main(words: Sequence[str] | None = None) -> int:
    """Run `mobnet COMMAND ...`; return its exit status."""
    words = sys.argv[1:] if words is None else words
    demo = Command("show a push as observer and network estimate it", demo_parser, "mobnet.demo")
    commands = {**COMMANDS, "demo": demo}
    if not words:
        overview(commands).print_help()
        return 2
    first, *others = words
    if first.startswith("-"):
        overview(commands).parse_args([first])
    if first not in commands:
        overview(commands).error(unknown_command(first, commands))
    if {"-h", "--help"} & set(others):
        commands[first].parser().parse_args(["--help"])
    # Here, as what a command imports takes seconds.
    if line := missing_input(commands[first].parser().parse_args(others)):
        sys.exit(line)
    try:
        module = with_extra(commands[first].module)
    except ConfigError as error:
        sys.exit(f"{PROGRAM} {first}: {error}")
    return int(module.main(others))


def overview(commands: dict[str, Command]) -> argparse.ArgumentParser:
    """Return the parser that knows all commands by a line."""
    lines = "".join(f"\n  {name:<11}{command.says}" for name, command in commands.items())
    parser = argparse.ArgumentParser(
        prog="mobnet",
        usage="mobnet COMMAND [OPTIONS]; mobnet COMMAND --help says which",
        description="Estimate the external torque of a robot without force sensors.",
        epilog=f"commands:{lines}",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--version", action="version", version=version())
    return parser

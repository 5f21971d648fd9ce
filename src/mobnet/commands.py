"""The commands of a lab: `mobnet observe LOG ...`, which in a checkout is `./reproduce observe LOG ...`.

What each one imports stands in its module, so that help is printed at once. A command names the extra of pyproject.toml
that it needs: where that is not installed, one line says so before anything is read or written.
"""

import argparse
import contextlib
import importlib
import os
import shutil
import sys
import textwrap
from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

from mobnet.core.errors import CommandError, ConfigError, MobnetError, not_accepted
from mobnet.core.libraries import drop_foreign_libraries
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
from mobnet.core.place import PROGRAM, check_extra, version
from mobnet.core.printed import shown, watch_output
from mobnet.core.word_checks import (
    check_calibrate,
    check_detect,
    check_export,
    check_identify,
    check_learn,
    check_motion,
    check_observe,
    check_robot,
)


class Command(NamedTuple):
    """A command: what it does, in a line; parser and check of its options; the module whose `main` runs it; its extra.

    The extra, if it needs one, is that of pyproject.toml whose packages the module imports, now or later.
    """

    says: str
    parser: Callable[[], argparse.ArgumentParser]
    check: Callable[[argparse.Namespace], None]
    module: str
    extra: str | None = None

    def read(self, words: Sequence[str]) -> argparse.Namespace:
        """Return the options that words are; nothing is imported but the standard library.

        Raises:
            MobnetError: a file is not there, or a value is not accepted.
        """
        options = self.parser().parse_args(words)
        if line := missing_input(options):
            raise CommandError(line)
        self.check(options)
        return options


COMMANDS = {
    "robot": Command(
        "make a robot's table from its URDF or MJCF file",
        import_parser,
        check_robot,
        "mobnet.robot.import_table",
        extra="simulate",
    ),
    "motion": Command(
        "simulate the log of a robot of a table that moves without walking",
        motion_parser,
        check_motion,
        "mobnet.robotlog.motion",
        extra="simulate",
    ),
    "observe": Command(
        "make the residual of a robot's own log, and say what looks wrong with it",
        observe_parser,
        check_observe,
        "mobnet.robotlog.observe",
        extra="logs",
    ),
    "identify": Command(
        "find friction and rotor inertia in logs of free motion, for the robot's table",
        identify_parser,
        check_identify,
        "mobnet.robotlog.identify",
        extra="logs",
    ),
    "learn": Command(
        "train a network on a robot's own logs, and try it on their end",
        learn_parser,
        check_learn,
        "mobnet.robotlog.learn",
        extra="learn",
    ),
    "calibrate": Command(
        "print thresholds of detection for a wanted rate of false alarms",
        calibrate_parser,
        check_calibrate,
        "mobnet.detection.calibrate",
    ),
    "detect": Command(
        "write when something pushes a limb in a robot's own log",
        detect_parser,
        check_detect,
        "mobnet.robotlog.detect",
        extra="logs",
    ),
    "export": Command(
        "write trained networks as ONNX files that run without this project",
        export_parser,
        check_export,
        "mobnet.export.export",
        extra="export",
    ),
}


GROUPS = {  # heading of the help -> commands
    "look": ("demo",),
    "your robot and its logs": ("robot", "motion", "observe", "identify"),
    "collisions": ("learn", "calibrate", "detect"),
    "your program": ("export",),
}
INDENT = 17  # columns of a help before what a command does


def demo_parser() -> argparse.ArgumentParser:
    """Return the parser of `mobnet demo`."""
    return argparse.ArgumentParser(
        prog="mobnet demo",
        description="Show a push on a walking robot as the observer and a trained network estimate it; both come with "
        "the package.",
    )


def main(words: Sequence[str] | None = None) -> int:
    """Run `mobnet COMMAND ...`, by default with the words of this program; return its exit status."""
    if words is None:
        if drop_foreign_libraries():
            os.execv(sys.executable, [sys.executable, *sys.orig_argv[1:]])  # the loader reads the variable at the start
        words = sys.argv[1:]
    says = "show a push as observer and network estimate it"
    demo = Command(says, demo_parser, lambda _: None, "mobnet.demo")
    commands = {**COMMANDS, "demo": demo}
    watch_output()
    if not words:
        overview(commands).print_help()
        return 2
    first, *others = words
    if first.startswith("-"):
        overview(commands).parse_args([first])
    if first not in commands:
        overview(commands).exit(2, f"mobnet: {not_accepted('command', first, commands)}\n")
    if {"-h", "--help"} & set(others):
        commands[first].parser().parse_args(["--help"])
    command = commands[first]
    try:
        if command.extra:
            check_extra(command.extra)
    except ConfigError as error:
        sys.exit(f"{PROGRAM} {first}: {error}")
    try:
        with contextlib.suppress(OSError):  # the command says what the system refuses
            options = command.read(others)
            importlib.import_module("mobnet.robot.word_checks").check_named(options)
    except MobnetError as error:
        sys.exit(shown(str(error)))
    # Here, as what a command imports takes seconds.
    return int(importlib.import_module(command.module).main(others))


def overview(commands: dict[str, Command]) -> argparse.ArgumentParser:
    """Return the parser that knows all commands by a line, in groups."""
    groups = {heading: {name: commands[name].says for name in names} for heading, names in GROUPS.items()}
    parser = argparse.ArgumentParser(
        prog="mobnet",
        usage="mobnet COMMAND [OPTIONS]",
        description=wrapped("Estimate the external torque of a robot without force sensors."),
        epilog=f"{in_groups(groups)}\n\n{wrapped('mobnet COMMAND --help says which options there are.')}",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--version", action="version", version=version())
    return parser


def in_groups(groups: Mapping[str, Mapping[str, str]]) -> str:
    """Return the part of a help that lists commands, a line for each, below the headings of their groups."""
    parts: list[str] = []
    for heading, commands in groups.items():
        parts.append("\n".join([f"{heading}:", *(line_of(name, says) for name, says in commands.items())]))
    return "\n\n".join(parts)


def line_of(name: str, says: str) -> str:
    """Return the line of a command in a help, or several where the terminal is narrow."""
    return wrapped(says, f"  {name:<{INDENT - 2}}", " " * INDENT)


def wrapped(text: str, first: str = "", others: str = "") -> str:
    """Return a text in lines as wide as argparse makes them, which begin with some signs."""
    return textwrap.fill(text, shutil.get_terminal_size().columns - 2, initial_indent=first, subsequent_indent=others)

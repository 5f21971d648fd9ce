"""What is wrong with the words of a lab's command, as far as words and folders tell. Standard library only.

`./reproduce` and `mobnet` ask before they import what a command needs, which takes seconds. Each command asks again, as
programs call it too. What takes the configuration and the robot's table to tell is in `mobnet.robot.word_checks`.
"""

import math
from argparse import Namespace
from pathlib import Path

from mobnet.core.errors import ConfigError, DataError, beyond, not_accepted, refuse_lines
from mobnet.core.files import RUN, check_place, stem_of
from mobnet.core.options import LABELS, MCAP, SIGNALS
from mobnet.core.place import command
from mobnet.core.rates import GAIN_HZ, RATE_HZ

RECORDING, ESTIMATE = "recording", "estimate"  # arrays in the folder of a log
ENDINGS = (".csv", ".parquet")  # of a simulated log
MOST_MINUTES = 60.0
LEAST_RATE = 1e-6  # wanted false alarms [1/h]
MEAN = SIGNALS[0]


def check_out(options: Namespace) -> None:
    """Check that the folder of what is made can be written to.

    Raises:
        DataError: it cannot.
    """
    if options.out:
        check_place(options.out)


def check_observe(options: Namespace) -> None:
    """Check the words of `observe`.

    Raises:
        DataError: the gain is not accepted, or the folder of what is made cannot be written to.
    """
    if options.gain is not None:
        refuse_lines(beyond("--gain", options.gain, GAIN_HZ))
    check_out(options)


def check_export(options: Namespace) -> None:
    """Check the words of `export`.

    Raises:
        DataError: rate or gain are not accepted, or the folder of what is made cannot be written to.
    """
    if options.rate is not None:
        refuse_lines(beyond("--rate", options.rate, RATE_HZ))
    check_observe(options)


def check_new_file(out: Path, *, force: bool) -> None:
    """Check that a file can be made, in place of another one only by force.

    Raises:
        ConfigError: it exists.
        DataError: its folder cannot be written to.
    """
    if out.exists() and not force:
        raise ConfigError(f"{out}: exists already; accepted: another --out, or --force")
    check_place(out.parent)


def check_log_folder(folder: Path) -> None:
    """Raise a DataError for a folder that `observe` did not write."""
    for name in (RECORDING, ESTIMATE):
        if not (folder / f"{name}.json").exists():
            accepted = f"a folder that `{command('observe')}` wrote"
            raise DataError(f"{folder}: {name}.json is missing; accepted: {accepted}")


def check_network_folder(folder: Path) -> None:
    """Raise a DataError for a folder that no training wrote."""
    if not (folder / RUN).exists():
        raise DataError(f"{folder}: {RUN} is missing; accepted: a folder that `{command('learn')}` wrote")


def check_robot(options: Namespace) -> None:
    """Check the words of `robot`.

    Raises:
        ConfigError: the table exists.
        DataError: a value is not accepted, or the table's folder cannot be written to.
    """
    floats(options.base)
    check_new_file(imported_table(options), force=options.force)


def floats(word: str | None) -> bool | None:
    """Return whether the base floats, by what a user said; None where nothing was said.

    Raises:
        DataError: it is neither of the two.
    """
    kinds = {None: None, "floating": True, "fixed": False}
    if word not in kinds:
        raise DataError(not_accepted("--base", word, ["fixed", "floating"]))
    return kinds[word]


def imported_table(options: Namespace) -> Path:
    """Return the table that `robot` makes."""
    return options.out or Path(f"{stem_of(options.file)}.yaml")


def check_motion(options: Namespace) -> None:
    """Check the words of `motion`.

    Raises:
        DataError: a value is not accepted, or the log's folder cannot be written to.
    """
    if options.out.suffix not in ENDINGS:
        raise DataError(f"--out: {not_accepted('ending', options.out.suffix, ENDINGS)}")
    if not 0.0 < options.minutes <= MOST_MINUTES or not math.isfinite(options.minutes):
        raise DataError(not_accepted("--minutes", options.minutes, [f"above 0 and up to {MOST_MINUTES:g}"]))
    if options.seed < 1:  # 0 would draw the motion by the numbers that hide the plant
        raise DataError(not_accepted("--seed", options.seed, ["a whole number from 1 on"]))
    check_place(options.out.parent)


def check_identify(options: Namespace) -> None:
    """Check the words of `identify`.

    Raises:
        ConfigError: the table exists.
        DataError: its folder cannot be written to.
    """
    if options.out:
        check_new_file(options.out, force=options.force)


def check_learn(options: Namespace) -> None:
    """Check the words of `learn`.

    Raises:
        DataError: a value or a folder is not accepted.
    """
    if options.labels not in LABELS:
        raise DataError(not_accepted("--labels", options.labels, LABELS))
    if options.epochs is not None and options.epochs < 1:
        raise DataError(not_accepted("--epochs", options.epochs, ["a whole number from 1"]))
    check_out(options)
    for folder in options.folders:
        check_log_folder(folder)


def check_calibrate(options: Namespace) -> None:
    """Check the words of `calibrate`.

    Raises:
        DataError: words contradict each other, or a value or a folder is not accepted.
    """
    if bool(options.folders) == bool(options.recording or options.estimate):
        given = "both are given" if options.folders else "nothing to calibrate from is given"
        folders = f"folders that `{command('observe')}` wrote"
        raise DataError(f"{given}; either {folders} are needed, or --recording with --estimate")
    if len(options.recording) != len(options.estimate):
        count = len(options.recording)
        raise DataError(not_accepted("--estimate", len(options.estimate), [f"{count}, one for each --recording"]))
    if not options.folders and (options.out or options.network):
        word = "--out" if options.out else "--network"
        given = options.out or options.network
        raise DataError(f"{word} {given}: it needs folders that `{command('observe')}` wrote")
    if options.signal not in (None, *SIGNALS):
        raise DataError(not_accepted("--signal", options.signal, SIGNALS))
    if options.folders and options.signal not in (None, MEAN) and not options.network:
        raise DataError(f"--signal {options.signal}: it needs --network; without, the signal is {MEAN}")
    if not LEAST_RATE <= options.rate < math.inf:
        raise DataError(not_accepted("--rate", options.rate, [f"a number from {LEAST_RATE:g}, one in a century"]))
    if options.out:
        check_place(options.out.parent)
    if options.network:
        check_network_folder(options.network)
    for folder in options.folders:
        check_log_folder(folder)


def check_detect(options: Namespace) -> None:
    """Check the words of `detect`.

    Raises:
        DataError: a folder or a file to be written is not accepted.
    """
    if options.out and options.out.suffix == MCAP:
        check_place(options.out.parent)
        if options.wrench:
            raise DataError(f"--wrench: is not written to {options.out}; accepted: a folder as --out")
    else:
        check_out(options)
    if options.network:
        check_network_folder(options.network)

"""Pushes in a log: `./reproduce detect LOG --robot TABLE --network NET --thresholds FILE` (docs/detection.md)."""

import logging
import sys
from argparse import Namespace
from collections.abc import Iterator

from mobnet.core.options import detect_parser
from mobnet.core.printed import printed
from mobnet.settings.lab import load_lab

log = logging.getLogger(__name__)
TELLING = ("mobnet.estimation.observer", "mobnet.estimation.estimate")  # they tell of each part of a long log


def run(options: Namespace) -> Iterator[str]:
    """Detect as the command's options say, and yield what is printed."""
    settings = load_lab()
    # Here: flags and the configuration are read before the second that numba and Pinocchio take.
    from mobnet.robotlog.detecting import detect

    yield from detect(options, settings)


def main(words: list[str]) -> int:
    """Run the command; return its exit status."""
    options = detect_parser().parse_args(words)
    for name in TELLING:
        logging.getLogger(name).setLevel(logging.WARNING)
    return printed(log, lambda: run(options))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

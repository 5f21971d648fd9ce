"""The words of `./reproduce`: its commands, or targets and options of snakemake."""

import argparse
import functools
import re
from collections.abc import Sequence
from typing import NamedTuple

from experiments.commands.install import BUILDS
from experiments.running.words import (
    MAIN,
    RESULTS,
    bench_parser,
    check_parser,
    cost_parser,
    demo_parser,
    results_parser,
)
from mobnet.commands import COMMANDS as LAB
from mobnet.core.errors import CommandError, unknown_command

COMMANDS = {
    "all": "make every table, figure and the paper (snakemake --cores 2 all); further options go to snakemake",
    "paper_core": "make Tables 5 and 6 and Figure 5 alone, section 5.1; --config scale=paper: at the paper's size",
    "demo": "show one push as three methods estimate it, without training; --help says how",
    "test": "run every test and check, the workflow at a small scale included; further options go to pytest",
    "verify": "list the missing, changed and unexpected files of a run, by results/MANIFEST.sha256",
    "check": "check recordings, weights and configurations from outside; --help says how",
    **{name: f"{command.says}; --help says how" for name, command in LAB.items()},
    "tuning": "train what configs/trials.yaml lists, write results/default/trials/tuning.md; not part of all",
    "recipes": "train each method with each recipe, write results/default/trials/recipes.md; not part of all",
    "lengths": "train for longer and longer, write results/default/trials/lengths.md; not part of all",
    "random_torque": "count falls by random torque, write results/default/trials/random_torque.md; not part of all",
    "films": "make films of walks into obstacles, results/default/films; not part of all",
    "docs": "make the documentation as pages, results/default/docs/index.html; not part of all",
    "report": "make everything, then report.html: every table and figure with its caption in one file",
    "compare": "list the differences between the published tables and figures, docs/results, and yours",
    "snapshot": "store your tables and figures as the published ones, docs/results",
    "cost": "print what a run will take: jobs, core-hours, memory, disk; with targets: what would run again",
    "bench": "run benchmarks and compare each number with its bound; --help says how",
    "clean": "remove results, tables, figures and paper outputs after a question; --help says how",
    "setup": "make .venv from environment.lock and stop; --cpu or --cuda: which build of torch",
}
EXAMPLES = """
  ./reproduce all -n                     show what would run
  ./reproduce all --config scale=smoke   the same line in minutes; its numbers mean nothing
  ./reproduce all --config scale=quick   every table and figure in about an hour, with shorter walks and trainings
  ./reproduce all --config keep=tables   let recordings go when nothing needs them any more: less disk
  ./reproduce tables/table_05.tex        make one file and what it needs; tables/smoke/table_05.tex at that scale"""
OWN = {"clean", "setup"}  # commands with options of their own
TRIALS = ("tuning", "recipes", "lengths", "random_torque")  # tables of trials, which `all` does not ask for
TARGETS = {
    "all": "all",
    "paper_core": "paper_core",
    "report": "all",
    "films": "films",
    "docs": "docs",
}  # command -> rule of the workflow
HELP = {"-h", "--help"}
PARSERS = {
    "bench": bench_parser,
    "check": check_parser,
    "cost": cost_parser,
    "demo": demo_parser,
    **{name: command.parser for name, command in LAB.items()},
    **{name: functools.partial(results_parser, name) for name in RESULTS},
}  # of commands whose module has words of its own
CONFIG = {"-C", "--config"}
SCALE = "scale="  # the key of the configuration that every target follows
KEY = re.compile(r"[a-zA-Z_]\w+")  # as Snakemake takes it: of two signs or more


class Words(NamedTuple):
    """A command, its own options, and the words that it hands on."""

    command: str
    options: argparse.Namespace
    extra: list[str]


def parse(words: Sequence[str]) -> Words:
    """Take the words apart; --help and words that are not accepted end the process as those of argparse do."""
    first = words[0] if words else "--help"
    if first in HELP:
        overview().print_help()
        overview().exit(0 if words else 2)
    if re.search(r"^-|[/.]", first):
        return Words("all", argparse.Namespace(), in_order(words))
    if first not in COMMANDS:
        overview().error(unknown_command(first, COMMANDS))
    options = parser_of(first)
    if first in OWN:
        return Words(first, options.parse_args(words[1:]), [])
    if HELP & set(words[1:]):
        options.parse_args(["--help"])
    if first in TRIALS:
        return Words(first, argparse.Namespace(), [table_of(first, words), *in_order(words[1:])])
    extra = [TARGETS[first], *in_order(words[1:])] if first in TARGETS else list(words[1:])
    return Words(first, argparse.Namespace(), extra)


def table_of(trial: str, words: Sequence[str]) -> str:
    """Return the table of a trial at the scale that the words name."""
    given = [word.removeprefix(SCALE) for word in words if word.startswith(SCALE)]
    return f"results/{given[-1] if given else MAIN}/trials/{trial}.md"


def overview() -> argparse.ArgumentParser:
    """Return the parser that knows all commands by a line."""
    listing = "".join(f"\n  {name:<15}{text}" for name, text in COMMANDS.items())
    return argparse.ArgumentParser(
        prog="./reproduce",
        usage="./reproduce COMMAND [OPTIONS], or ./reproduce TARGET...",
        description="Set up the project and run it: one command from an empty machine to every table and figure.",
        epilog=f"commands:{listing}\n{EXAMPLES}",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )


def parser_of(command: str) -> argparse.ArgumentParser:
    """Return the parser of a command's own options."""
    if command in PARSERS:
        return PARSERS[command]()
    usage = None if command in OWN else f"./reproduce {command} [OPTIONS]"
    parser = argparse.ArgumentParser(f"./reproduce {command}", usage, description=COMMANDS[command], allow_abbrev=False)
    if command == "clean":
        parser.add_argument("--all", action="store_true", help="remove .venv and the caches too")
        parser.add_argument("-n", "--dry-run", action="store_true", help="list what would go, and remove nothing")
        parser.add_argument("--yes", action="store_true", help="remove without a question")
    if command == "setup":
        build = parser.add_mutually_exclusive_group()
        for name in BUILDS:
            build.add_argument(
                f"--{name}", dest="build", action="store_const", const=name, help=f"the {name.upper()} build of torch"
            )
    return parser


def in_order(words: Sequence[str]) -> list[str]:
    """Return words in the order that Snakemake needs: targets before `--config`, which would take them for values.

    Raises:
        CommandError: what replaces a key of the configuration does not name one.
    """
    targets: list[str] = []
    others: list[str] = []
    taking = False
    for word in words:
        if taking and "=" in word and not word.startswith("-") and not KEY.fullmatch(word.partition("=")[0]):
            raise CommandError(f"--config: {word!r} is not accepted; accepted: KEY=VALUE, a key of configs")
        swallowed = taking and not word.startswith("-") and "=" not in word
        (targets if swallowed else others).append(word)
        taking = word in CONFIG or (taking and not word.startswith("-"))
    if others and others[-1] in CONFIG:
        raise CommandError(f"{others[-1]}: {' '.join(targets) or 'nothing'} is not accepted; accepted: KEY=VALUE")
    return [*targets, *others]

"""The words of `./reproduce`: its commands, or targets and options of snakemake."""

import argparse
import functools
import re
import sys
from collections.abc import Sequence
from difflib import get_close_matches
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

from experiments.commands.install import BUILDS
from experiments.running.words import (
    RESULTS,
    bench_parser,
    check_parser,
    cost_parser,
    demo_parser,
    draw_parser,
    joined,
    list_option,
    paper_parser,
    results_parser,
    scale_given,
    sheet_parser,
    value_beside,
)
from mobnet.commands import COMMANDS as LAB
from mobnet.commands import in_groups, line_of, version, wrapped
from mobnet.core.code import ROOT
from mobnet.core.errors import CommandError, not_accepted

OWN_ROBOT = "your own robot"
DESCRIPTION = "Set up the project and run it: from an empty machine to every table and figure."
GROUPS = {  # heading of the help -> command -> what it does, in a line
    "run": {
        "all": "make every table, figure and the paper; further options go to snakemake",
        "paper_core": "make Tables 5 and 6 and Figure 5 alone, section 5.1",
        "report": "make everything, then report.html: tables and figures in one file",
        "cost": "print what a run will take: jobs, core-hours, memory, disk",
        "sheet": "print what the rules read: a row for each set, network, table, ...",
        "setup": "make .venv from environment.lock and stop",
        "clean": "remove what runs have made, after a question",
    },
    "look": {
        "demo": "show one push as three methods estimate it, without training",
        "draw": "draw published figures as SVG and PDF, without a run",
        "paper": "build the paper as PDF from the published results, without a run",
        "docs": "make the documentation as pages",
        "films": "make films of walks into obstacles",
    },
    OWN_ROBOT: {name: command.says for name, command in LAB.items()},
    "publish": {
        "check": "check recordings, weights and configurations from outside",
        "verify": "list missing, changed and unexpected files of a run",
        "compare": "list differences between the published results and yours",
        "snapshot": "store your tables and figures as the published ones, docs/results",
    },
    "develop": {
        "test": "run every test and check; further options go to pytest",
        "bench": "run benchmarks and compare each number with its bound",
        "tuning": "train what configs/trials.yaml lists, and compare",
        "recipes": "train each method with each recipe",
        "lengths": "train for longer and longer",
        "random_torque": "count falls by the size of random torques",
        "factorial": "train from walks with and without torques, pushes, variety",
        "why": "train with other inputs, robots and recipes: why is a hit hidden?",
    },
}
# Tables of trials, which `all` does not ask for.
TRIALS = ("tuning", "recipes", "lengths", "random_torque", "factorial", "why")
COMMANDS = {name: says for group in GROUPS.values() for name, says in group.items()}
MORE = {  # command -> what its own --help adds to that line
    "all": "The rule `all` of snakemake, on 2 cores unless --cores says another number.",
    "paper_core": "With --config scale=paper it is made at the size of the original.",
    "docs": "They begin at results/default/docs/index.html.",
    "films": "They are written to results/default/films.",
    "test": "The workflow at a small scale is among them.",
    **dict.fromkeys(TRIALS, "The table is written to results/default/trials."),
}
APART = (
    "`all` makes neither docs and films nor the tables of tuning, recipes, lengths, random_torque, factorial and why."
)
EXAMPLES = {
    "all -n": "show what would run",
    "all --config scale=smoke": "the same in minutes; its numbers mean nothing",
    "all --config scale=quick": "everything in about an hour, with shorter walks and trainings",
    "all --config keep=tables": "let recordings go when nothing needs them any more: less disk",
    "tables/table_05.md": "make one file and what it needs; tables/smoke/table_05.md at that scale",
}
PROGRAM = "./reproduce"
OWN = {"clean", "setup"}  # commands with options of their own
TARGETS = {
    "all": "all",
    "paper_core": "paper_core",
    "report": "all",
    "films": "films",
    "docs": "docs",
}  # command -> rule of the workflow
HELP = {"-h", "--help"}
VERSION = {"-v", "--version"}
LIKE = 0.6  # share of the signs that a word has in common with a name that may be meant
PARSERS = {
    "bench": bench_parser,
    "check": check_parser,
    "cost": cost_parser,
    "demo": demo_parser,
    "sheet": sheet_parser,
    "draw": draw_parser,
    "paper": paper_parser,
    **{name: command.parser for name, command in LAB.items()},
    **{name: functools.partial(results_parser, name) for name in RESULTS},
}  # of commands whose module has words of its own
CONFIG = {"-C", "--config"}
CORES = {"-c": "all", "--cores": "all", "-j": "unlimited", "--jobs": "unlimited"}  # option -> as many as there are
KEY = re.compile(r"[a-zA-Z_]\w+")  # as Snakemake takes it: of two signs or more


class Words(NamedTuple):
    """A command, its own options, and the words that it hands on."""

    command: str
    options: argparse.Namespace
    extra: list[str]


def parse(words: Sequence[str]) -> Words:
    """Take the words apart; --help and words that are not accepted end the process as those of argparse do."""
    first = words[0] if words else "--help"
    if first == "help":
        return parse([*words[1:2], "--help"])
    if first in VERSION:
        sys.stdout.write(versions())
        sys.exit(0)
    if first in HELP:
        overview().print_help()
        overview().exit(0 if words else 2)
    if re.search(r"^-|[/.]", first):
        return Words("all", argparse.Namespace(), in_order(words))
    if first not in COMMANDS:
        overview().exit(2, f"reproduce: {unknown(first)}\n")
    options = parser_of(first)
    if first in OWN:
        return Words(first, options.parse_args(words[1:]), [])
    if HELP & set(words[1:]):
        options.parse_args(["--help"])
    if first in TRIALS:
        return Words(first, argparse.Namespace(), [table_of(first, words), *in_order(words[1:])])
    if first == "cost":
        others = in_order(words[1:])
        return Words(first, argparse.Namespace(), [target_of(word, words) for word in others])
    extra = [TARGETS[first], *in_order(words[1:])] if first in TARGETS else list(words[1:])
    return Words(first, argparse.Namespace(), extra)


def unknown(word: str) -> str:
    """Return the one line about what is no command, with the names like it if there are any."""
    names = [*COMMANDS, *captioned()]
    stems = [Path(name).stem for name in names]
    if get_close_matches(word, stems, 1, LIKE):
        return not_accepted("command or target", word, names)
    return f"command or target: {word!r} is not accepted; {PROGRAM} --help lists all"


def versions() -> str:
    """Return the line that says which version of the project this is, and of Snakemake, which may not be there yet."""
    lock = (ROOT / "environment.lock").read_text()
    match = re.search(r"^snakemake==(\S+)", lock, re.MULTILINE)
    return f"mobnet {version()}" + (f" (snakemake {match[1]})" if match else "") + "\n"


def target_of(word: str, words: Sequence[str]) -> str:
    """Return the target that a command makes, at the scale that the words name; a word of another kind as it is."""
    return table_of(word, words) if word in TRIALS else TARGETS.get(word, word)


def table_of(trial: str, words: Sequence[str]) -> str:
    """Return the table of a trial at the scale that the words name."""
    return f"results/{scale_given(words)}/trials/{trial}.md"


def overview() -> argparse.ArgumentParser:
    """Return the parser that knows all commands by a line, in groups."""
    examples = [f"examples, after {PROGRAM}:"]
    for words, says in EXAMPLES.items():
        examples += [f"  {words}", line_of("", says)]
    parts = [in_groups(GROUPS), "\n".join(examples), wrapped(f"{APART} COMMAND --help says more.")]
    return argparse.ArgumentParser(
        prog=PROGRAM,
        usage=f"{PROGRAM} COMMAND [OPTIONS]\n       {PROGRAM} TARGET...",
        description=wrapped(DESCRIPTION),
        epilog="\n\n".join(parts),
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )


def captioned() -> list[str]:
    """Return tables and figures as targets, by their captions: their plan needs packages."""
    targets: list[str] = []
    for folder, ending in (("tables", ".tex"), ("figures", ".pdf")):
        captions = sorted((ROOT / "workflow" / "report" / folder).glob("*.rst"))
        targets += [f"{folder}/{caption.stem}{ending}" for caption in captions]
    return targets


def parser_of(command: str) -> argparse.ArgumentParser:
    """Return the parser of a command's own options."""
    if command in PARSERS:
        return PARSERS[command]()
    usage = None if command in OWN else f"{PROGRAM} {command} [OPTIONS]"
    says = f"{COMMANDS[command][:1].upper()}{COMMANDS[command][1:]}. {MORE.get(command, '')}"
    parser = argparse.ArgumentParser(f"{PROGRAM} {command}", usage, description=says, allow_abbrev=False)
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
        CommandError: what replaces a key of the configuration does not name one, or a number of cores is missing.
    """
    targets: list[str] = []
    others: list[str] = []
    taking = False
    for word in opened(words):
        if taking and "=" in word and not word.startswith("-") and not KEY.fullmatch(word.partition("=")[0]):
            raise CommandError(f"--config: {word!r} is not accepted; accepted: KEY=VALUE, a key of configs")
        swallowed = taking and not word.startswith("-") and "=" not in word
        (targets if swallowed else others).append(word)
        taking = word in CONFIG or (taking and not word.startswith("-"))
    if others and others[-1] in CONFIG:
        raise CommandError(f"{others[-1]}: {' '.join(targets) or 'nothing'} is not accepted; accepted: KEY=VALUE")
    for word, behind in pairwise([*others, "--"]):
        if word in CORES and behind.startswith("-"):
            raise CommandError(f"{word}: its number is missing; accepted: {word} 2, or {word} {CORES[word]}")
    return joined([*targets, *others])


def opened(words: Sequence[str]) -> list[str]:
    """Return words in which `--config` and its first value are two, also where they were one, as --config=seed=3."""
    words_opened: list[str] = []
    for word in words:
        is_one = list_option(word) == "--config" and word not in CONFIG
        words_opened += ["--config", *value_beside(word)] if is_one else [word]
    return words_opened

"""The words of commands about a run, and of its targets. Standard library only: help comes before the environment."""

import argparse
import re
from collections.abc import Iterable, Sequence
from pathlib import Path

from mobnet.core.errors import ConfigError, near_names

MAIN = "default"  # the scale whose tables stand where a reader looks for them; others have folders of their own
SCALE = "scale="  # the key of the configuration that every target follows
MANIFEST = Path("results/MANIFEST.sha256")
KINDS = (
    "a recording, residual, estimate, wrench or motion (.parquet with its .json), weights.safetensors, run.json, "
    "metrics.csv, scores, what detectors find, a fit, an account of a job, a file of configs, a robot's table, "
    "a folder of these"
)
# Options of Snakemake that take several values, and their other names.
LISTS = (
    "--allowed-rules",
    "--cache",
    "--cleanup-metadata",
    "--config",
    "--configfile",
    "--consider-ancient",
    "--default-resources",
    "--envvars",
    "--forcerun",
    "--group-components",
    "--groups",
    "--logger",
    "--omit-flags",
    "--omit-from",
    "--preemptible-rules",
    "--prioritize",
    "--quiet",
    "--rerun-triggers",
    "--resources",
    "--set-resource-scopes",
    "--set-resources",
    "--set-scatter",
    "--set-threads",
    "--shared-fs-usage",
    "--software-deployment-method",
    "--strict-dag-evaluation",
    "--target-jobs",
    "--unneeded-temp-files",
    "--until",
    "--wait-for-files",
)
ALIASES = {
    "-C": "--config",
    "-O": "--omit-from",
    "-P": "--prioritize",
    "-R": "--forcerun",
    "-U": "--until",
    "-q": "--quiet",
    "--cm": "--cleanup-metadata",
    "--configfiles": "--configfile",
    "--default-res": "--default-resources",
    "--deployment": "--software-deployment-method",
    "--deployment-method": "--software-deployment-method",
    "--res": "--resources",
    "--sdm": "--software-deployment-method",
}
SHEETS = (
    "sets",
    "fits",
    "networks",
    "stacks",
    "tests",
    "scores",
    "detectors",
    "watched",
    "reactions",
    "shown",
)
RESULTS = {  # command -> what it does with the results of a run
    "verify": "List the missing, changed and unexpected files of a run, by its manifest.",
    "compare": "List the differences between the published tables and figures, docs/results, and those of this folder.",
    "snapshot": "Store the tables and figures of this folder as the published ones, docs/results.",
}


def check_parser() -> argparse.ArgumentParser:
    """Return the parser of `./reproduce check`."""
    parser = argparse.ArgumentParser(prog="./reproduce check", description="Check files before they are used.")
    parser.add_argument("files", nargs="+", type=Path, metavar="FILE", help=f"accepted: {KINDS}")
    parser.add_argument("--robot", type=Path, help="the robot's table (default: that of configs)")
    parser.add_argument("--rate", type=float, metavar="HZ", help="samples per second (default: that of configs)")
    return parser


def demo_parser() -> argparse.ArgumentParser:
    """Return the parser of `./reproduce demo`; paths are None where they are not given."""
    parser = argparse.ArgumentParser(
        prog="./reproduce demo", description="Show one push as three methods estimate it, without training."
    )
    parser.add_argument("--out", type=Path, help="the picture: .png, .pdf or .svg (default: results/demo.png)")
    parser.add_argument("--data", type=Path, help="folder of the stored push (default: docs/demo)")
    return parser


def draw_parser() -> argparse.ArgumentParser:
    """Return the parser of `./reproduce draw`; the folder is None where it is not given."""
    parser = argparse.ArgumentParser(
        prog="./reproduce draw",
        description="Draw published figures as SVG and PDF from their numbers in docs/results, without a run.",
    )
    parser.add_argument(
        "figures", nargs="*", metavar="FIGURE", help="such as figure_05 (default: all whose CSV has all that is drawn)"
    )
    parser.add_argument("--out", type=Path, help="folder of the drawings (default: results/drawn)")
    return parser


def paper_parser() -> argparse.ArgumentParser:
    """Return the parser of `./reproduce paper`."""
    parser = argparse.ArgumentParser(
        prog="./reproduce paper",
        description="Build the paper as PDF from the published results in docs/results, without a run; it needs TeX.",
    )
    parser.add_argument(
        "--out", type=Path, default=Path("results/paper"), help="folder of main.pdf (default: %(default)s)"
    )
    return parser


def cost_parser() -> argparse.ArgumentParser:
    """Return the parser of `./reproduce cost`."""
    parser = argparse.ArgumentParser(
        prog="./reproduce cost",
        description="Print the jobs, core-hours, memory and disk of a run, priced by the rates of the published one.",
    )
    parser.add_argument(
        "targets",
        nargs="*",
        metavar="TARGET",
        help="`all`, or files: price what a run of them would start now (default: a run from nothing)",
    )
    add_config(parser, "keys of the configuration, such as scale=quick, as ./reproduce all takes them")
    return parser


def sheet_parser() -> argparse.ArgumentParser:
    """Return the parser of `./reproduce sheet`."""
    parser = argparse.ArgumentParser(
        prog="./reproduce sheet",
        description="Print what the rules read: a row for each set, network, test, table or figure.",
    )
    parser.add_argument("name", metavar="NAME", help=f"the sheet: {', '.join(SHEETS)}")
    parser.add_argument("rows", nargs="*", metavar="ROW", help="such as table_07 of the sheet shown (default: all)")
    add_config(parser, "keys of the configuration, such as scale=smoke, as ./reproduce all takes them")
    return parser


def results_parser(command: str) -> argparse.ArgumentParser:
    """Return the parser of one of the commands that look at the results of a run."""
    parser = argparse.ArgumentParser(prog=f"./reproduce {command}", description=RESULTS[command])
    if command != "compare":
        parser.add_argument(
            "--manifest", type=Path, help=f"list of files with their hashes (default: {MANIFEST}, or that of the scale)"
        )
    add_config(parser, "scale=smoke: that scale's run; docs/results is of the scale default")
    return parser


def add_config(parser: argparse.ArgumentParser, says: str) -> None:
    """Add the option for keys of the configuration, which may be given several times."""
    parser.add_argument("--config", "-C", nargs="+", action="extend", default=[], metavar="KEY=VALUE", help=says)


def scale_given(words: Sequence[str]) -> str:
    """Return the scale that words KEY=VALUE of the configuration name."""
    given = [word.removeprefix(SCALE) for word in words if word.startswith(SCALE)]
    return given[-1] if given else MAIN


def manifest_of(scale: str) -> Path:
    """Return the list of a scale's files with their hashes."""
    return MANIFEST if scale == MAIN else MANIFEST.parent / scale / MANIFEST.name


def bench_parser() -> argparse.ArgumentParser:
    """Return the parser of `./reproduce bench`."""
    parser = argparse.ArgumentParser(
        prog="./reproduce bench", description="Run benchmarks and print one table, in which each number has its bound."
    )
    parser.add_argument(
        "names",
        nargs="*",
        metavar="NAME",
        help="modules of benchmarks, such as collect_hour (default: those that compare speed)",
    )
    parser.add_argument("--out", type=Path, default=Path("results/bench.csv"), help="CSV (default: %(default)s)")
    return parser


def joined(words: Sequence[str]) -> list[str]:
    """Return words in which an option of several values stands once: of two `--config` Snakemake keeps the last."""
    others, values, last = parted(words)
    for name, given in values.items():
        others += [name, *given]
    return [*others, *last]


def refuse_twice(words: Sequence[str]) -> None:
    """Refuse words of Snakemake that it would leave out without a word.

    Raises:
        ConfigError: an option of several values is given twice.
    """
    _, values, _ = parted(words)
    for name, given in values.items():
        together = " ".join([name, *given])
        raise ConfigError(f"{name}: is given twice, and Snakemake keeps the last alone; accepted: {together}")


def parted(words: Sequence[str]) -> tuple[list[str], dict[str, list[str]], list[str]]:
    """Return words, those of options of several values that stand twice with all their values, and what `--` begins."""
    end = words.index("--") if "--" in words else len(words)
    names = [list_option(word) for word in words[:end]]
    values: dict[str, list[str]] = {name: [] for name in LISTS if names.count(name) > 1}
    others: list[str] = []
    taking: list[str] | None = None
    for word, name in zip(words[:end], names, strict=True):
        if name in values:
            value = value_beside(word)
            values[name] += value
            taking = None if value else values[name]
        elif taking is None or word.startswith("-"):
            taking = None
            others.append(word)
        else:
            taking.append(word)
    return others, values, list(words[end:])


def list_option(word: str) -> str | None:
    """Return the name of the option of several values that a word is, None where it is none."""
    flag = word.partition("=")[0] if word.startswith("--") else word[:2]
    flag = ALIASES.get(flag, flag)
    if flag in LISTS:
        return flag
    # Snakemake takes the beginning of a name for the name, and refuses one that is the beginning of several.
    is_part = flag.startswith("--") and flag != "--"
    return next((name for name in LISTS if name.startswith(flag)), None) if is_part else None


def value_beside(word: str) -> list[str]:
    """Return the value that stands in one word with its option, as in --config=seed=3 and -Cseed=3, if any."""
    if word.startswith("--"):
        return [word.partition("=")[2]] if "=" in word else []
    return [word[2:]] if word[2:] else []


def scale_of(target: str) -> str | None:
    """Return the scale that the path of a target names, None where it is no path of a result.

    A folder of a scale, such as tables/smoke, is no target, and may be a file without its ending.
    """
    if re.fullmatch(r"(?:\./)*(?:results|tables|figures|paper)/[^/.]+/?", target):
        return None
    match = re.match(r"(?:\./)*(?:results|tables|figures|paper)/(?:([^/]+)/)?", target)
    return (match[1] or MAIN) if match else None


def scale_of_targets(words: Iterable[str], given: object = None) -> str | None:
    """Return the scale to which the targets among the words of a call belong; None where they name none.

    Args:
        words: of the call.
        given: the scale that the call gives by its name.

    Raises:
        ConfigError: targets belong to several scales, or to another one than is given.
    """
    word_of = {scale: word for word in words if (scale := scale_of(word))}
    if given is not None:
        word_of.pop(str(given), None)
        for scale, word in word_of.items():
            raise ConfigError(f"{word}: is not made at scale={given}; accepted: --config scale={scale}")
        return str(given)
    if len(word_of) > 1:
        raise ConfigError(f"targets of the scales {', '.join(sorted(word_of))}: one scale can be made at a time")
    return next(iter(word_of), None)


def one_of(names: Iterable[str]) -> str:
    """Return the pattern of a wildcard that stands for some names; of no name where there is none."""
    return "|".join(map(re.escape, names)) or "(?!)"


def nearest(target: str, known: Sequence[str]) -> str:
    """Return the one line that says that a target is none, with the names nearest to it."""
    return f"{target}: is no target; did you mean {', '.join(near_names(known, target))}? (the nearest of {len(known)})"


def in_set(target: str, folder: str) -> str:
    """Return the one line that says that a target is a file of a set, which one job makes whole."""
    return f"{target}: is a file of a set; the target is its folder, {folder}"

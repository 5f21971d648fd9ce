"""The words of a call of Snakemake, once its rules are known: targets, and options that name rules.

Snakemake tells a wrong target after it has worked out the whole graph, and takes an option that names a rule that there
is not without a word.
"""

from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

from experiments.plan.files import made_by_jobs
from experiments.plan.product import Folders
from experiments.running.words import in_set, nearest
from mobnet.core.errors import not_accepted

OF_RULES = ("set_threads", "set_resources", "groups", "allowed_rules", "consider_ancient", "preemptible_rules")
OF_RULES_AND_FILES = ("forcerun", "until", "omit_from", "prioritize")
CWL = "--export-cwl: Snakemake writes no CWL any more and would start the run; leave it out"
WHOLE = {"results": "all", "tables": "tables", "figures": "figures"}  # folder -> rule that makes all that stands in it

Rules = Sequence[Any]


def faults_of_words(words: Any, rules: Rules, shown: Sequence[str], scales: Iterable[str]) -> Iterator[str]:
    """Yield one line for each word of a call that would do nothing, or something else than it says.

    Args:
        words: as Snakemake takes them apart.
        rules: of the workflow.
        shown: files of all products.
        scales: all that there are.
    """
    names = [str(rule.name) for rule in rules]
    if words.export_cwl:
        yield CWL
    for option in OF_RULES:
        for name in getattr(words, option) or ():
            if name not in names:
                yield not_accepted(f"{typed(option)}: rule", name, names)
    for name in words.set_scatter:
        yield not_accepted("--set-scatter", name, ())
    if words.default_storage_provider:  # files have other names there, which Snakemake checks itself
        return
    for option in OF_RULES_AND_FILES:
        for name in getattr(words, option) or ():
            if name not in names and not is_made(name, rules):
                yield f"{typed(option)}: {nearest(name, [*names, *shown])}"
    for target in map(str, words.targets):
        if target not in names and not is_made(target, rules):
            yield fault_of_target(target, rules, shown, scales)


def typed(option: str) -> str:
    """Return an option as it is typed."""
    return f"--{option.replace('_', '-')}"


def fault_of_target(target: str, rules: Rules, shown: Sequence[str], scales: Iterable[str]) -> str:
    """Return the one line that says what to ask for in place of what no rule makes."""
    place = Path(target)
    first, *below = place.parts
    if first in WHOLE and (not below or (len(below) == 1 and below[0] in scales)):
        scale = "".join(f" --config scale={name}" for name in below)
        return f"{target}: is a folder; accepted: {WHOLE[first]}{scale}, or a file in it"
    made = next((file for file in made_by_jobs([place]) if is_made(file, rules)), None)
    if made is not None:
        return f"{target}: is a folder; accepted: {made}" if place in Path(made).parents else in_set(target, made)
    inside = [file for file in shown if place in Path(file).parents]
    if inside or place.is_dir():
        example = f", such as {inside[0]}" if inside else ""
        return f"{target}: is a folder; accepted: a file in it that a rule makes{example}"
    return nearest(target, [*(str(rule.name) for rule in rules), *shown])


def is_made(target: str, rules: Rules) -> bool:
    """Return whether a rule makes a file or a folder."""
    return any(rule.is_producer(target.rstrip("/")) for rule in rules)


def asks_for_all(targets: Sequence[str]) -> bool:
    """Return whether a call asks for all that the workflow makes, as it does without a target."""
    return not targets or list(targets) == ["all"]


def made_line(targets: Sequence[str], rules: Rules, folders: Folders) -> str:
    """Return the line that says what a run has made: what was asked for, or the folders of all and where to begin."""
    if not asks_for_all(targets):
        files = [file_of(target, rules) for target in targets]
        return f"{', '.join(files)} {'is' if len(files) == 1 else 'are'} made"
    page = folders.results / "pages" / "index.html"
    return f"{folders.tables}, {folders.figures} and {folders.paper} are made; begin with {page}"


def file_of(target: str, rules: Rules) -> str:
    """Return the first file that a target's rule makes where the target is a rule, otherwise the target."""
    made = [file for rule in rules if rule.name == target for file in rule.output]
    return str(made[0]) if made and not made[0].contains_wildcard() else target

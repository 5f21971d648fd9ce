"""Code that reads plainly: a name says what it is, one step stands on a line, long functions say why.

The numbers are today's, rounded up: lower them where the code has become plainer, never raise them.
"""

import ast
import tokenize
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path

import pytest

SOURCE = Path(__file__).parents[3] / "src"
MOST_NESTED = 1.5  # nested comprehensions in 1000 lines
MOST_AT_ONCE = 6.5  # assignments of several values at once in 1000 lines
LONG_LINES, LEAST_COMMENTS = 12, 15.0  # lines of a long function; comments in 1000 lines of long functions
# Name of a class -> why several modules have it.
PROTOCOLS = {"Options": "the numbers of a kind or of a measure; the loader finds it by this name in each module"}
SAY_NOTHING = {"found", "own", "told", "held", "one"}  # as names of values: each says no more than "something"
MOST_THAT_SAY_NOTHING = {"mobnet": 45, "experiments": 710}
MOST_WITH_SETTINGS = 54  # modules of the library, those of `settings` apart
MOST_CLASSES = {"experiments/evaluation": 89}  # what pandas frames hold needs none
COMPREHENSIONS = (ast.ListComp, ast.SetComp, ast.DictComp, ast.GeneratorExp)
FUNCTIONS = (ast.FunctionDef, ast.AsyncFunctionDef)


def modules(folder: Path) -> Iterator[tuple[Path, ast.Module, int]]:
    """Yield each module below a folder, with its syntax and its number of lines."""
    for path in sorted(folder.rglob("*.py")):
        text = path.read_text(encoding="utf-8")
        yield path, ast.parse(text), len(text.splitlines())


def per_thousand(count: int, lines: int) -> float:
    return 1000.0 * count / lines


@pytest.mark.parametrize("package", ["mobnet", "experiments"])
def test_one_step_stands_on_a_line(package: str) -> None:
    nested, at_once, lines = 0, 0, 0
    for _, tree, length in modules(SOURCE / package):
        lines += length
        for node in ast.walk(tree):
            if isinstance(node, COMPREHENSIONS):
                nested += any(isinstance(below, COMPREHENSIONS) for below in ast.walk(node) if below is not node)
            if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Tuple):
                at_once += isinstance(node.value, ast.Tuple)
    assert per_thousand(nested, lines) <= MOST_NESTED
    assert per_thousand(at_once, lines) <= MOST_AT_ONCE


def test_most_of_the_library_knows_no_configuration() -> None:
    settings = SOURCE / "mobnet" / "settings"
    knowing = [
        path
        for path, tree, _ in modules(SOURCE / "mobnet")
        if not path.is_relative_to(settings) and any(map(is_of_settings, ast.walk(tree)))
    ]
    assert len(knowing) <= MOST_WITH_SETTINGS


def is_of_settings(node: ast.AST) -> bool:
    """Return whether a node imports a section of the configuration."""
    names = [alias.name for alias in node.names] if isinstance(node, ast.Import | ast.ImportFrom) else []
    of = f"{node.module}." if isinstance(node, ast.ImportFrom) else ""
    return any(f"{of}{name}.".startswith("mobnet.settings.") for name in names)


@pytest.mark.parametrize("folder", ["experiments/plan", "experiments/evaluation", "mobnet/robotlog"])
def test_long_functions_say_why(folder: str) -> None:
    comments, lines = 0, 0
    for path, tree, _ in modules(SOURCE / folder):
        whole = whole_line_comments(path)
        for node in ast.walk(tree):
            if isinstance(node, FUNCTIONS) and (node.end_lineno or 0) - node.lineno >= LONG_LINES:
                own = range(node.lineno, (node.end_lineno or 0) + 1)
                lines += len(own)
                comments += len(whole.intersection(own))
    assert per_thousand(comments, lines) >= LEAST_COMMENTS


def whole_line_comments(path: Path) -> set[int]:
    """Return the lines of a module that are comments alone."""
    with path.open("rb") as file:
        tokens = list(tokenize.tokenize(file.readline))
    return {
        token.start[0]
        for token in tokens
        if token.type == tokenize.COMMENT and not token.line[: token.start[1]].strip()
    }


def test_a_name_of_a_class_has_one_meaning() -> None:
    found = defaultdict[str, set[str]](set)
    for path, tree, _ in modules(SOURCE):
        for node in ast.walk(tree):
            if isinstance(node, ast.ClassDef):
                found[node.name].add(str(path.relative_to(SOURCE)))
    several = {name: sorted(own) for name, own in found.items() if len(own) > 1 and name not in PROTOCOLS}
    assert several == {}


@pytest.mark.parametrize("package", ["mobnet", "experiments"])
def test_a_value_is_named_by_what_it_is(package: str) -> None:
    count = 0
    for _, tree, _ in modules(SOURCE / package):
        for node in ast.walk(tree):
            name = node.id if isinstance(node, ast.Name) else node.arg if isinstance(node, ast.arg) else ""
            count += name in SAY_NOTHING
    assert count <= MOST_THAT_SAY_NOTHING[package]


@pytest.mark.parametrize("folder", list(MOST_CLASSES))
def test_what_frames_hold_has_no_class_of_its_own(folder: str) -> None:
    count = 0
    for _, tree, _ in modules(SOURCE / folder):
        count += sum(isinstance(node, ast.ClassDef) for node in ast.walk(tree))
    assert count <= MOST_CLASSES[folder]

"""Of settings and plan the hash of code follows names; whatever code that makes results uses of them is in its hash.

What is used is found without the hash: by the types that fields have when Python runs, and by the names that compiled
functions load.
"""

from __future__ import annotations

import ast
import contextlib
import dis
import importlib
import inspect
import pkgutil
import shutil
import typing
from collections.abc import Callable, Iterator
from functools import cache, cached_property
from itertools import chain
from pathlib import Path
from types import CodeType, ModuleType

import pytest

from mobnet.core import code, source
from mobnet.core.code import ROOT, SOURCE, code_hash

PACKAGES = ("mobnet.formats", "mobnet.settings", "experiments.settings", "experiments.plan")
CHECKS = ("mobnet.formats.checks", "experiments.settings.checks")
MAKERS = ("mobnet", "experiments/jobs", "experiments/evaluation")  # folders of the code that makes results
# What code takes of modules that are not followed: notes, names of states and caches, and where the project lies.
NOTED = {
    "CHANGED", "LOGS", "PACKAGES", "ROOT", "SHORT", "SOURCE", "UNKNOWN", "code_hash", "commit", "job", "provenance",
    "source_hash",
}  # fmt: skip
BOUNDS = {"ge", "gt", "le", "lt", "min_length", "max_length"}
Name = tuple[str, str]  # a module, and what stands in it, such as `RobotTable.layout`


@cache
def declaring() -> dict[str, ModuleType]:
    """Return the modules of the packages of which names are followed."""
    found = {}
    for package in map(importlib.import_module, PACKAGES):
        for module in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
            if not module.name.startswith(CHECKS) and not module.name.endswith("__main__"):
                found[module.name] = importlib.import_module(module.name)
    return found


@cache
def tree_of(path: Path) -> ast.Module:
    return ast.parse(path.read_text())


@cache
def constants(module: str) -> dict[str, ast.stmt]:
    """Return the statements that assign the names of a module."""
    found = {}
    for statement in tree_of(Path(declaring()[module].__file__)).body:
        if isinstance(statement, ast.Assign | ast.AnnAssign):
            targets = statement.targets if isinstance(statement, ast.Assign) else [statement.target]
            for target in targets:
                found |= dict.fromkeys(names_in(target), statement)
    return found


def names_in(node: ast.AST) -> set[str]:
    return {each.id for each in ast.walk(node) if isinstance(each, ast.Name)}


@cache
def attributes_in(path: Path) -> dict[str, set[str]]:
    """Return the attributes that a file uses of each name; of no name, all that it uses of anything else."""
    found: dict[str, set[str]] = {}
    for node in ast.walk(tree_of(path)):
        if isinstance(node, ast.Attribute):
            name = node.value.id if isinstance(node.value, ast.Name) else ""
            found.setdefault(name, set()).add(node.attr)
    return found


@cache
def imports_of(path: Path) -> tuple[Name, ...]:
    """Return module and name of what a file imports, and of what it takes of a module that it imports."""
    found = []
    for node in ast.walk(tree_of(path)):
        if isinstance(node, ast.ImportFrom):
            for alias in node.names:
                whole = f"{node.module}.{alias.name}"
                if whole in declaring():
                    found += [(whole, name) for name in attributes_in(path).get(alias.asname or alias.name, ())]
                else:
                    found.append((node.module, alias.name))
    return tuple(found)


@cache
def classes_of(owner: type | Callable) -> set[type]:
    """Return the classes of settings and plan in the types of a class's fields, or of a function's parameters."""
    found = set()
    if inspect.isclass(owner):
        found |= {base for base in owner.__mro__[1:] if base.__module__ in declaring()}
    for hint in typing.get_type_hints(owner, include_extras=True, localns=known_to_type_checkers()).values():
        found |= classes_in(hint)
    return found


def classes_in(hint: object) -> set[type]:
    """Return the classes of settings and plan in a type."""
    found = {hint} if inspect.isclass(hint) and hint.__module__ in declaring() else set()
    for inner in typing.get_args(hint):
        found |= classes_in(inner)
    return found


@cache
def known_to_type_checkers() -> dict[str, object]:
    """Return all classes of settings and plan by name, and a type: some modules know them while types are checked."""
    found: dict[str, object] = {"Hours": Callable}
    for module in declaring().values():
        found |= {name: value for name, value in vars(module).items() if inspect.isclass(value)}
    return found


@cache
def methods_of(kind: type) -> dict[str, Callable]:
    """Return the methods and properties of a class as functions."""
    found = {}
    for name, value in vars(kind).items():
        if inspect.isfunction(value):
            found[name] = value
        elif isinstance(value, classmethod):
            found[name] = value.__func__
        elif isinstance(value, property):
            found[name] = value.fget
        elif isinstance(value, cached_property):
            found[name] = value.func
    return found


@cache
def loaded_by(compiled: CodeType) -> tuple[set[str], set[str]]:
    """Return the names of globals and of attributes that a function and the functions in it load."""
    loaded, attributes = set(), set()
    for instruction in dis.get_instructions(compiled):
        if instruction.opname == "LOAD_GLOBAL":
            loaded.add(instruction.argval)
        elif instruction.opname in ("LOAD_ATTR", "LOAD_METHOD"):
            attributes.add(instruction.argval)
    for constant in compiled.co_consts:
        if isinstance(constant, CodeType):
            inner_loaded, inner_attributes = loaded_by(constant)
            loaded |= inner_loaded
            attributes |= inner_attributes
    return loaded, attributes


class Used:
    """What a file uses of settings and plan."""

    def __init__(self, path: Path) -> None:
        self.names: set[Name] = set()
        self.classes: set[type] = set()
        self.attributes = set().union(*attributes_in(path).values())
        for module, name in imports_of(path):
            if module in declaring():
                self.add(declaring()[module], name)
        before = -1
        while before < self.size:
            before = self.size
            for kind in tuple(self.classes):
                self.add_methods(kind)

    @property
    def size(self) -> int:
        return len(self.names) + len(self.classes) + len(self.attributes)

    def add(self, module: ModuleType, name: str) -> None:
        """Add what a name stands for in a module."""
        value = inspect.unwrap(getattr(module, name, None))
        if inspect.isfunction(value):
            self.add_function(value)
        elif inspect.isclass(value) and value.__module__ in declaring():
            self.add_class(value)
        elif name in constants(module.__name__):
            self.add_constant(module, name, value)
        else:
            for other, own in imports_of(Path(module.__file__)):
                if own == name and other in declaring():
                    self.add(declaring()[other], name)

    def add_constant(self, module: ModuleType, name: str, value: object) -> None:
        """Add a constant and those that it is made of; of what stands for a type, the classes."""
        if typing.get_origin(value) is not None:
            for kind in classes_in(value):
                self.add_class(kind)
        elif not isinstance(value, typing.TypeVar) and (module.__name__, name) not in self.names:
            self.names.add((module.__name__, name))
            for other in names_in(constants(module.__name__)[name].value):
                self.add(module, other)

    def add_function(self, function: Callable) -> None:
        """Add a function and what it uses."""
        name = (function.__module__, function.__qualname__)
        is_written = name[0] in declaring() and function.__code__.co_filename == declaring()[name[0]].__file__
        if not is_written or name in self.names or is_check(name):
            return
        self.names.add(name)
        for kind in classes_of(function):
            self.add_class(kind)
        loaded, attributes = loaded_by(function.__code__)
        self.attributes |= attributes
        for other in loaded:
            self.add(declaring()[function.__module__], other)

    def add_class(self, kind: type) -> None:
        """Add a class with those of its fields."""
        if kind not in self.classes:
            self.classes.add(kind)
            for other in classes_of(kind):
                self.add_class(other)

    def add_methods(self, kind: type) -> None:
        """Add those methods of a class whose names are used."""
        for name, function in methods_of(kind).items():
            if name in self.attributes or name.startswith("__"):
                self.add_function(function)


def is_check(name: Name) -> bool:
    return name[1].endswith("problems")


@cache
def makers() -> tuple[Path, ...]:
    """Return the files of code that makes results."""
    found = list(ROOT.glob("workflow/scripts/*.py"))
    for folder in MAKERS:
        found += SOURCE.joinpath(folder).rglob("*.py")
    kept = [SOURCE.joinpath(*name.split(".")) for name in PACKAGES]
    return tuple(path for path in found if not any(path.is_relative_to(folder) for folder in kept))


@cache
def users() -> dict[Name, tuple[Path, ...]]:
    """Return what is used of settings and plan, with the files that use it, directly or not."""
    found = {}
    for path in makers():
        text = path.read_text()
        if not any(package in text for package in PACKAGES):
            continue  # most files: their trees take a while to look through
        for name in Used(path).names:
            found.setdefault(name, []).append(path)
    return {name: tuple(paths) for name, paths in sorted(found.items())}


class Kept:
    """What a function returned, of which a file can be forgotten."""

    def __init__(self, function: Callable) -> None:
        self.function = function
        self.known = {}

    def __call__(self, part):
        if part not in self.known:
            self.known[part] = self.function(part)
        return self.known[part]

    def without(self, path: Path) -> dict:
        """Return what is known of other files."""
        return {part: value for part, value in self.known.items() if getattr(part, "path", part) != path}


class Copy:
    """A copy of the project's code, whose files can be changed."""

    def __init__(self, folder: Path, patch: pytest.MonkeyPatch) -> None:
        self.folder = folder
        shutil.copytree(SOURCE, folder / "src", ignore=shutil.ignore_patterns("__pycache__"))
        shutil.copytree(ROOT / "workflow" / "scripts", folder / "workflow" / "scripts")
        self.kept = Kept(source.read.__wrapped__), Kept(source.read_declared.__wrapped__)
        for module in (code, source):
            patch.setattr(module, "SOURCE", folder / "src")
        patch.setattr(code, "read", self.kept[0])
        patch.setattr(source, "read_declared", self.kept[1])
        self.before = {path: self.hash(path) for path in makers()}

    def hash(self, path: Path) -> str:
        """Return the hash of the code behind a file of the project in the copy."""
        return code_hash.__wrapped__(self.folder / path.relative_to(ROOT))

    def is_same(self, path: Path) -> bool:
        """Return whether the hash of the code behind a file is that before any change."""
        return self.hash(path) == self.before[path]

    @contextlib.contextmanager
    def changed(self, texts: dict[Path, str]) -> Iterator[None]:
        """Change files of the project in the copy for a while."""
        known = [kept.known for kept in self.kept]
        for path, text in texts.items():
            own = self.folder / path.relative_to(ROOT)
            own.write_text(text)
            for kept in self.kept:
                kept.known = kept.without(own)
        yield
        for path in texts:
            shutil.copyfile(path, self.folder / path.relative_to(ROOT))
        for kept, before in zip(self.kept, known, strict=True):
            kept.known = before


@pytest.fixture(scope="module")
def copy(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Copy]:
    cached = (source.module_files, source.declared_parts)
    for function in cached:
        function.cache_clear()
    with pytest.MonkeyPatch.context() as patch:
        yield Copy(tmp_path_factory.mktemp("copy"), patch)
    for function in cached:
        function.cache_clear()


def with_another(name: Name, path: Path) -> str:
    """Return the text of a module in which a function returns nothing, or a constant is nothing."""
    *outer, last = name[1].split(".")
    body = tree_of(path).body
    for kind in outer:
        body = next(node.body for node in body if isinstance(node, ast.ClassDef) and node.name == kind)
    lines = path.read_text().splitlines()
    if name[1] in constants(name[0]):
        changed = constants(name[0])[name[1]]
        first, new = changed.lineno, f"{last} = None"
    else:
        changed = next(node for node in body if isinstance(node, ast.FunctionDef) and node.name == last)
        first, new = changed.body[0].lineno, f"{' ' * changed.body[0].col_offset}return None"
    return "\n".join([*lines[: first - 1], new, *lines[changed.end_lineno :]])


def unnoticed(copy: Copy) -> list[str]:
    """Return the names whose change is not in the hash of a file that uses them."""
    found = []
    for name, paths in users().items():
        path = Path(declaring()[name[0]].__file__)
        with copy.changed({path: with_another(name, path)}):
            same = [str(user.relative_to(ROOT)) for user in paths if copy.is_same(user)]
        if same:
            found.append(f"{'.'.join(name)}, used by {', '.join(same)}")
    return found


def test_names_that_change_results_are_found() -> None:
    known = {"unit_of_metric", "FIRST_SEED", "TOGETHER_S", "FIRST_TRAINING_SEED", "RobotTable.layout", "IN_A_STACK"}
    assert known <= {place for _, place in users()}


def test_a_change_of_what_code_uses_is_in_its_hash(copy: Copy) -> None:
    assert not unnoticed(copy)


def with_other_words(path: Path) -> str:
    """Return the text of a module with other docstrings and messages of errors, other bounds, and no comments."""
    tree = ast.parse(path.read_text())
    for node in ast.walk(tree):
        called = node.func.id if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) else ""
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef) and ast.get_docstring(node):
            node.body[0] = ast.parse("'Other text.'").body[0]
        elif isinstance(node, ast.Raise) and isinstance(node.exc, ast.Call):
            node.exc.args = [ast.Constant("another message")]
        elif called == "Field":
            for keyword in node.keywords:
                if keyword.arg in BOUNDS:
                    keyword.value = ast.Constant(1)
        elif called in source.ERROR_TEXTS:
            node.args = [ast.Constant("another message")]
        elif isinstance(node, ast.FunctionDef) and is_check(("", node.name)):
            node.body = ast.parse("return None").body
    return ast.unparse(tree)


def test_other_comments_docstrings_bounds_and_messages_are_in_no_hash(copy: Copy) -> None:
    paths = [Path(module.__file__) for module in declaring().values()]
    with copy.changed({path: with_other_words(path) for path in paths}):
        assert not [path for path in makers() if not copy.is_same(path)]


def test_a_job_uses_no_columns_of_tables_and_no_verdicts() -> None:
    """Another column of a table makes that table again; no robot walks for it, and no network learns."""
    for path in SOURCE.joinpath("experiments", "jobs").glob("*.py"):
        if is_check(("", path.stem)):  # read before a run begins, and by no job
            continue
        used = chain.from_iterable(each.parts for each in code.reached([source.CodePart(path)]))
        assert not {part.path.name for part in used} & {"table_columns.py", "verdicts.py", "claim_ranges.py"}, path


def test_of_what_is_not_followed_code_takes_notes_and_places_alone() -> None:
    for path in makers():
        text = path.read_text()
        if path.name not in ("code.py", "source.py", "source_cache.py") and any(
            module in text for module in source.NOT_FOLLOWED
        ):
            taken = [name for module, name in imports_of(path) if module.startswith(source.NOT_FOLLOWED)]
            made = [name for name in taken if not is_check(("", name))]  # a check refuses, and makes nothing
            assert not set(made) - NOTED, path


def test_settings_and_plan_hold_nothing_but_definitions() -> None:
    """What else stood in a module could change results, and belongs to no name."""
    accepted = ast.Import | ast.ImportFrom | ast.FunctionDef | ast.ClassDef | ast.Assign | ast.AnnAssign
    for module in declaring().values():
        for statement in tree_of(Path(module.__file__)).body:
            assert isinstance(statement, accepted) or source.is_idle(statement), ast.unparse(statement)

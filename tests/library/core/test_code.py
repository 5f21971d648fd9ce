"""The hash of the code behind a result changes with what the code does, and with nothing else."""

from __future__ import annotations

import importlib.metadata
import re
import subprocess
import sys
from pathlib import Path

import pytest

from experiments.plan.items import detectors, texts
from experiments.plan.product import SCRIPT, Call, Product
from mobnet.core import code, source
from mobnet.core.code import code_hash, lock_lines, required
from mobnet.core.errors import ConfigError
from mobnet.core.source import CodePart, declared_parts, is_declaring, module_files, read, read_declared

CACHED = (code_hash, lock_lines, required, read, read_declared, module_files, declared_parts, is_declaring)
ONE = '''"""One."""
import logging
import warnings
from typing import TYPE_CHECKING

from mobnet.core.errors import DataError, not_accepted
from mobnet.two import f

if TYPE_CHECKING:
    import typed

log = logging.getLogger(__name__)


def g(x, y=None):
    """Text."""
    if x > 1:
        raise DataError(f"{x}: too large")
    if y is not None:
        return not_accepted("y", y, [None])
    log.info("x is %d", x)
    warnings.warn("slow", stacklevel=2)
    return f()
'''
TWO = """import one_dist.part
from mobnet.settings import plant
from mobnet.settings.plant import OTHER
from mobnet.settings.robot import Robot, Row


def f(robot: Robot, mass: plant.Mass):
    row = 1
    return robot.weight(), plant.twice(mass), OTHER, Row(size=row)
"""
PLANT = '''"""Plants."""
from mobnet.core.errors import misfit
from mobnet.settings.base import Section

MOST = 7
FIRST = 1
OTHER = FIRST, 1
unused = 1
Mass = Annotated[float, Real, Field(le=9)]


class Plant(Section):
    """Text."""

    mass: Mass
    height: float = Field(default=0.5, ge=0, le=5)

    @model_validator(mode="before")
    def _spelt(cls, row):
        return row if "name" in row else {}

    @model_validator(mode="after")
    def _fits(self):
        if self.mass > MOST:
            raise ValueError("too heavy")
        return self

    def problems(self, text):
        if len(text) > 3:
            yield "no size"

    @property
    def double(self) -> float:
        return 2 * self.mass


def twice(mass: Mass) -> float:
    if mass is None:
        return misfit(mass, "kilograms")
    return _twice(mass)


def _twice(value):
    return 2 * value
'''
ROBOT = '''"""Robots."""
from mobnet.settings import base
from mobnet.settings.plant import Plant


class Robot(base.Section):
    """A robot, which code gets."""

    plant: Plant | None = None

    def weight(self):
        return 4 * self.plant.mass


class Row(base.Section):
    """A row, which code makes."""

    count: int = 1
    size: int = Field(default=3, ge=1)
'''
LOCK = """one-dist==1.0 \\
    --hash=sha256:aa
needed==2.0
other==3.0
"""


@pytest.fixture(autouse=True)
def fresh():
    """Nothing is remembered from one test to the next."""
    forget()
    yield
    forget()


def forget() -> None:
    for function in CACHED:
        function.cache_clear()


@pytest.fixture
def root(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A script and a package: script -> one -> two -> names of settings; three stands alone."""
    texts = {
        "script.py": "from mobnet import one\n",
        "mobnet/__init__.py": '"""Root."""\n',
        "mobnet/one.py": ONE,
        "mobnet/two.py": TWO,
        "mobnet/three.py": "x = 1\n",
        "mobnet/settings/__init__.py": "",
        "mobnet/settings/plant.py": PLANT,
        "mobnet/settings/robot.py": ROBOT,
        "mobnet/formats/__init__.py": "",
        "mobnet/formats/checks/__init__.py": "",
        "mobnet/formats/checks/plant.py": "x = 1\n",
        "environment.lock": LOCK,
    }
    for name, text in texts.items():
        (tmp_path / name).parent.mkdir(exist_ok=True, parents=True)
        (tmp_path / name).write_text(text)
    monkeypatch.setattr(code, "SOURCE", tmp_path)
    monkeypatch.setattr(source, "SOURCE", tmp_path)
    monkeypatch.setattr(code, "LOCK", tmp_path / "environment.lock")
    monkeypatch.setattr(importlib.metadata, "requires", requirements)
    return tmp_path


def requirements(name: str) -> list[str] | None:
    """Return what a made-up distribution requires; only one is installed."""
    if name != "one-dist":
        raise importlib.metadata.PackageNotFoundError(name)
    return ["Needed[more] (>=1)", "absent; sys_platform == 'win32'", 'other>=3; extra == "test"']


def is_changed_by(root: Path, name: str, old: str, new: str) -> bool:
    """Return whether replacing a text in a file changes the script's hash."""
    before, text = code_hash(root / "script.py"), (root / name).read_text()
    assert old in text
    (root / name).write_text(text.replace(old, new))
    forget()
    return code_hash(root / "script.py") != before


@pytest.mark.parametrize(
    ("name", "old", "new", "counts"),
    [
        ("mobnet/one.py", '"""Text."""', '"""Other text."""', False),
        ("mobnet/one.py", '    """Text."""\n', "", False),
        ("mobnet/one.py", "    return f()", "    # why\n    return f(  )", False),
        ("mobnet/one.py", "too large", "more than 1", False),
        ("mobnet/one.py", 'f"{x}: too large"', '"too large: " + str(x)', False),
        ("mobnet/one.py", '"y", y, [None]', '"y of g", y, (None,)', False),
        ("mobnet/one.py", "x is", "x = ", False),
        ("mobnet/one.py", '    log.info("x is %d", x)\n', "", False),
        ("mobnet/one.py", '"slow"', '"slower"', False),
        ("mobnet/one.py", "import typed", "import typed, other", False),
        ("mobnet/three.py", "1", "2", False),
        ("mobnet/settings/plant.py", '"""Text."""', '"""Other text."""', False),
        ("mobnet/settings/plant.py", "ge=0, le=5", "ge=1, le=6", False),
        ("mobnet/settings/plant.py", "ge=0, le=5", "ge=0, le=MOST", False),
        ("mobnet/settings/plant.py", "Field(le=9)", "Field(le=MOST)", False),
        ("mobnet/settings/plant.py", "Real, Field(le=9)", "Real, Field(le=8)", False),
        ("mobnet/settings/plant.py", "MOST = 7", "MOST = 8", False),
        ("mobnet/settings/plant.py", "mass: Mass", "mass: Mass | None", False),
        ("mobnet/settings/plant.py", "default=0.5", "default=0.6", False),
        ("mobnet/settings/plant.py", "too heavy", "heavier than 7", False),
        ("mobnet/settings/plant.py", "self.mass > MOST", "self.mass > 2 * MOST", False),
        ("mobnet/settings/plant.py", "len(text) > 3", "len(text) > 4", False),
        ("mobnet/settings/plant.py", "no size", "not a size", False),
        ("mobnet/settings/plant.py", "kilograms", "tons", False),
        ("mobnet/settings/plant.py", "unused = 1", "unused = 2", False),
        ("mobnet/settings/plant.py", "class Plant", "class Further(Section):\n    x: int = 1\n\n\nclass Plant", False),
        ("mobnet/settings/plant.py", "-> float:", "-> int:", False),
        ("mobnet/formats/checks/plant.py", "1", "2", False),
        ("environment.lock", "aa", "bb", False),
        ("environment.lock", "other==3.0", "other==3.1", False),
        ("mobnet/two.py", "row = 1", "row = 2", True),
        ("mobnet/two.py", "row = 1", 'row = "1"', True),
        ("mobnet/settings/plant.py", "2 * self.mass", "3 * self.mass", True),
        ("mobnet/settings/plant.py", "def _twice", "@cached\ndef _twice", True),
        ("mobnet/settings/plant.py", "2 * value", "3 * value", True),
        ("mobnet/settings/plant.py", "FIRST = 1", "FIRST = 2", True),
        ("mobnet/settings/plant.py", "OTHER = FIRST, 1", "OTHER = FIRST, 2", True),
        ("mobnet/settings/plant.py", '"name" in row', '"title" in row', True),
        ("mobnet/settings/robot.py", "4 * self.plant.mass", "5 * self.plant.mass", True),
        ("mobnet/settings/robot.py", "count: int = 1", "count: int = 2", True),
        ("mobnet/settings/robot.py", "default=3, ge=1", "default=4, ge=1", True),
        ("mobnet/settings/robot.py", "default=3, ge=1", "default=3, ge=2", False),
        ("mobnet/one.py", "x > 1", "x > 2", True),
        ("mobnet/one.py", "raise DataError", "raise ValueError", True),
        ("mobnet/one.py", "return f()", "from mobnet.three import x\n    return f()", True),
        ("script.py", "one", "two", True),
        ("environment.lock", "one-dist==1.0", "one-dist==1.1", True),
        ("environment.lock", "needed==2.0", "needed==2.1", True),
    ],
)
def test_what_can_change_a_result_counts_and_nothing_else(
    root: Path, name: str, old: str, new: str, counts: bool
) -> None:
    assert is_changed_by(root, name, old, new) == counts


def test_an_import_inside_a_function_is_followed(root: Path) -> None:
    (root / "mobnet/two.py").write_text("def f():\n    from mobnet.three import x\n    return x\n")
    assert is_changed_by(root, "mobnet/three.py", "1", "2")


@pytest.mark.parametrize("name", ["mobnet.one", "mobnet.one:g"])
def test_a_dotted_name_is_its_file(root: Path, name: str) -> None:
    assert code_hash(name) == code_hash(root / "mobnet/one.py")


@pytest.mark.parametrize("name", ["mobnet.none", "mobnet.none:g", "none.py"])
def test_code_that_does_not_exist_is_named(root: Path, name: str) -> None:
    with pytest.raises(ConfigError, match=f"^{name}: no such code; accepted: a file, or a module of mobnet"):
        code_hash(name)


def test_notes_of_provenance_do_not_count() -> None:
    assert [file.name for file in module_files("mobnet.core.files")] == ["__init__.py", "__init__.py", "files.py"]
    assert not module_files("mobnet.core.code.provenance")


def test_without_a_lock_no_package_counts(root: Path) -> None:
    (root / "environment.lock").unlink()
    assert not lock_lines()
    assert len(code_hash(root / "script.py")) == code.SHORT


def test_hash_needs_the_standard_library_only() -> None:
    line = "from mobnet.core.code import code_hash; print(code_hash('mobnet.learning.train'))"
    start = "import sys; sys.path.insert(0, 'src'); "
    done = subprocess.run([sys.executable, "-I", "-S", "-c", start + line], check=True, capture_output=True, text=True)
    assert len(done.stdout.strip()) == code.SHORT


# The project's own code.


def project_files() -> list[Path]:
    """Return all source files and scripts."""
    return [*code.SOURCE.rglob("*.py"), *code.SOURCE.parent.glob("workflow/scripts/*.py")]


def test_every_package_that_is_imported_has_a_line_in_the_lock() -> None:
    missing: dict[str, Path] = {}
    for path in project_files():
        missing |= {name: path for name in read(CodePart(path)).packages if name not in lock_lines()}
    assert not missing


def test_names_in_the_lock_are_those_of_the_installed_packages() -> None:
    installed = importlib.metadata.packages_distributions()
    for name, wanted in source.DISTRIBUTIONS.items():
        assert wanted in {source.lock_name(found) for found in installed.get(name, [wanted])}


def test_a_new_mujoco_counts_for_the_code_that_imports_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    before = {path: code_hash(path) for path in project_files()}
    users = {path for path in before if {"mujoco", "mink"} & packages_behind(path)}
    line = lock_lines()["mujoco"]
    (tmp_path / "lock").write_text(code.LOCK.read_text().replace(line, "mujoco==0.0.0"))
    monkeypatch.setattr(code, "LOCK", tmp_path / "lock")
    forget()
    assert {path for path in before if code_hash(path) != before[path]} == users
    library = code.SOURCE / "mobnet"
    parts = {str(path.relative_to(library)) for path in users if path.is_relative_to(library)}
    assert {"simulation/record.py", "robot/plant.py"} <= parts
    assert not {"estimation/observe.py", "learning/train.py", "control/walking.py"} & parts


def test_the_hash_of_a_rule_has_its_script() -> None:
    found: list[str] = []
    for path in sorted(code.ROOT.glob("workflow/rules/*.smk")):
        for rule in re.split(r"^(?:use )?rule ", path.read_text(), flags=re.MULTILINE)[1:]:
            scripts = re.findall(r'"\.\./scripts/(\w+)\.py"', rule)
            hashed = re.findall(r'code=code\("(\w+)"', rule)
            # The hash of a product has the script of all products.
            assert hashed == scripts or (scripts == ["product"] and "**product(" in rule), rule
            found += scripts
    assert set(found) | {"warm"} == {path.stem for path in code.ROOT.glob("workflow/scripts/*.py")}


def test_the_hash_of_a_product_has_its_script_and_the_function_that_it_imports_late() -> None:
    hashes = {late: Product("a", Call(late, {}), (), ()).code for late in (texts.docs, detectors.links)}
    assert hashes[texts.docs] == code_hash(SCRIPT, "experiments.plan.items.texts:docs")
    starts = [code.part_of("experiments.plan.items.detectors:links")]
    files = {part.path for source_of_part in code.reached(starts) for part in source_of_part.parts}
    tables = code.SOURCE / "experiments" / "evaluation" / "tables" / "further"
    assert tables / "links.py" in files
    # Its row, rows beside it and what they read are no part of it: a job gets their values.
    assert {path for path in files if path.parent == tables} == {tables / "links.py", tables / "__init__.py"}
    assert not {path for path in files if "plan" in path.parts} - {code.SOURCE / "experiments/plan/detection.py"}


def packages_behind(path: Path) -> set[str]:
    """Return the packages that a file and what it imports of this package import."""
    return {name for part in code.reached([CodePart(path)]) for name in part.packages}

"""The hash of the code behind a result changes with what the code does, and with nothing else."""

from __future__ import annotations

import importlib.metadata
import subprocess
import sys
from pathlib import Path

import pytest

from mobnet.core import code
from mobnet.core.code import code_hash, lock_lines, module_files, read, required
from mobnet.core.errors import ConfigError

CACHED = (code_hash, read, module_files, lock_lines, required)
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
    """A script and a package: script -> one -> two; three stands alone, settings is not followed."""
    texts = {
        "script.py": "from mobnet import one\n",
        "mobnet/__init__.py": '"""Root."""\n',
        "mobnet/one.py": ONE,
        "mobnet/two.py": "from mobnet.settings.plant import Plant\nimport one_dist.part\n\n\ndef f():\n    return 1\n",
        "mobnet/three.py": "x = 1\n",
        "mobnet/settings/__init__.py": "",
        "mobnet/settings/plant.py": "x = 1\n",
        "environment.lock": LOCK,
    }
    for name, text in texts.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text)
    monkeypatch.setattr(code, "SOURCE", tmp_path)
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
        ("mobnet/settings/plant.py", "1", "2", False),
        ("environment.lock", "aa", "bb", False),
        ("environment.lock", "other==3.0", "other==3.1", False),
        ("mobnet/two.py", "return 1", "return 2", True),
        ("mobnet/two.py", "return 1", 'return "1"', True),
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
    missing = {name: path for path in project_files() for name in read(path).packages if name not in lock_lines()}
    assert not missing


def test_names_in_the_lock_are_those_of_the_installed_packages() -> None:
    installed = importlib.metadata.packages_distributions()
    for name, wanted in code.DISTRIBUTIONS.items():
        assert wanted in {code.lock_name(found) for found in installed.get(name, [wanted])}


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


def packages_behind(path: Path) -> set[str]:
    """Return the packages that a file and what it imports of this package import."""
    return {name for source in code.reached([path]) for name in source.packages}

"""A command of a lab that needs an extra of pyproject.toml says so in one line, before it reads or writes anything."""

import ast
import re
import sys
import tomllib
from pathlib import Path

import pytest

import mobnet
from mobnet import commands
from mobnet.core import place
from mobnet.core.errors import ConfigError
from mobnet.core.source import DISTRIBUTIONS, SOURCE, lock_name
from mobnet.learning.deployed import loading

MOBNET = SOURCE / "mobnet"
ASKED = {  # file -> files that it imports after it has asked for their extra itself, as a test below shows
    MOBNET / "robot" / "given.py": {MOBNET / "robot" / "import_table.py"},
    MOBNET / "interface.py": {
        MOBNET / "export" / "export.py",
        MOBNET / "robotlog" / "shown.py",
    },
    MOBNET / "learning" / "deployed" / "loading.py": {MOBNET / "learning" / "deployed" / "module_network.py"},
}
DEMO = commands.Command("", commands.demo_parser, lambda _: None, "mobnet.demo")
MODULES = {**commands.COMMANDS, "demo": DEMO}
WORDS = {  # that each command accepts in the folder of the test
    "robot": ["arm.urdf", "--out", "new.yaml"],
    "motion": ["--robot", "arm.yaml", "--minutes", "0.01"],
    "observe": ["log.csv", "--robot", "arm.yaml"],
    "identify": ["log.csv", "--robot", "arm.yaml"],
    "learn": ["log", "--robot", "arm.yaml"],
    "detect": ["log.csv", "--robot", "arm.yaml", "--thresholds", "limb.yaml"],
    "export": ["log", "--robot", "arm.yaml", "--out", "made"],
}


def extras() -> dict[str, set[str]]:
    """Return the packages of each extra of pyproject.toml."""
    told = tomllib.loads((place.ROOT / "pyproject.toml").read_text())["project"]["optional-dependencies"]
    found: dict[str, set[str]] = {}
    for extra, lines in told.items():
        found[extra] = {lock_name(re.split("[<>=]", line)[0]) for line in lines}
    return found


def distributions(names: tuple[str, ...]) -> set[str]:
    """Return the packages that bring modules of some names."""
    return {DISTRIBUTIONS.get(name, lock_name(name)) for name in names}


def packages_of(module: str) -> set[str]:
    """Return the packages that a module imports, directly or not, now or later, unless it asks for them."""
    waiting = [SOURCE / Path(*module.split(".")).with_suffix(".py")]
    seen: set[Path] = set()
    found: set[str] = set()
    while waiting:
        path = waiting.pop()
        if path in seen:
            continue
        seen.add(path)
        for name in imports_of(path):
            files = files_of(name)
            waiting += set(files) - ASKED.get(path, set())
            if not files and name.partition(".")[0] not in sys.stdlib_module_names:
                found |= distributions((name.partition(".")[0],))
    return found


def imports_of(path: Path) -> set[str]:
    """Return the full names of all that a file imports, but for type checkers alone."""
    found: set[str] = set()
    waiting: list[ast.AST] = [ast.parse(path.read_text(encoding="utf-8"))]
    while waiting:
        node = waiting.pop()
        if isinstance(node, ast.Import):
            found.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            found.update(f"{node.module}.{alias.name}" for alias in node.names)
        elif not (isinstance(node, ast.If) and isinstance(node.test, ast.Name) and node.test.id == "TYPE_CHECKING"):
            waiting += ast.iter_child_nodes(node)
    return found


def files_of(name: str) -> list[Path]:
    """Return the files of the project that importing a name runs: its packages, and itself where it is a module."""
    parts = name.split(".")
    places = [SOURCE.joinpath(*parts[: count + 1]) for count in range(len(parts))]
    found = [place / "__init__.py" for place in places] + [place.with_suffix(".py") for place in places]
    return [file for file in found if file.is_file()]


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with what the words name, in which the commands run as those of an installed package."""
    data = place.ROOT / "tests" / "data"
    for name in ("arm.yaml", "arm.urdf"):
        (tmp_path / name).write_bytes((data / name).read_bytes())
    (tmp_path / "log").mkdir()
    for name in ("log.csv", "limb.yaml", "log/recording.json", "log/estimate.json", "log/run.json"):
        (tmp_path / name).touch()
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(place, "IS_CHECKOUT", False)
    monkeypatch.setattr(commands, "PROGRAM", "mobnet")
    return tmp_path


def test_the_extras_are_those_of_the_project():
    told = {extra: distributions(names) for extra, names in place.EXTRAS.items()}
    assert told == extras()


def test_the_page_of_the_package_says_which_command_needs_which_extra():
    page = (place.ROOT / "docs" / "interface.md").read_text()
    rows = re.findall(r"^\| `?(\w+)`? \| (.*) \| .* \|$", page.partition("| extra | for |")[2], re.MULTILINE)
    for extra, text in rows[: 1 + len(place.EXTRAS)]:
        named = set(re.findall(r"`(\w+)`", text)) & set(MODULES)
        wanted = None if extra == "none" else extra
        assert named == {name for name, command in MODULES.items() if command.extra == wanted}


def test_the_readme_installs_what_its_four_commands_need():
    part = (place.ROOT / "README.md").read_text().split("\n## Your own robot")[1].split("\n## ")[0]
    (installed,) = re.findall(r"`pip install '\.\[(.*)\]'` installs it all as `mobnet`", part)
    four = re.findall(r"^ {4}\./reproduce (\w+)", part, re.MULTILINE)
    assert len(four) == 4
    assert {MODULES[name].extra for name in four} - {None} == set(installed.split(","))


@pytest.mark.parametrize("name", MODULES)
def test_a_command_imports_packages_of_no_extra_but_its_own(name):
    """Found by the import statements of all code that the command may reach."""
    command = MODULES[name]
    imported = packages_of(command.module)
    needed = [extra for extra, packages in extras().items() if packages & imported]
    assert needed == ([command.extra] if command.extra else [])


@pytest.mark.parametrize(("name", "package"), [
    (name, package)
    for name, command in commands.COMMANDS.items()
    if command.extra
    for package in place.EXTRAS[command.extra]
])  # fmt: skip
def test_a_missing_package_is_one_line_and_nothing_is_written(name, package, folder, monkeypatch):
    monkeypatch.setitem(sys.modules, package, None)
    before = sorted(folder.rglob("*"))
    with pytest.raises(SystemExit) as refused:
        commands.main([name, *WORDS[name]])
    remedy = f"pip install 'mobnet[{commands.COMMANDS[name].extra}]'"
    assert refused.value.code == f"mobnet {name}: {package} is not installed; accepted: what `{remedy}` installs"
    assert sorted(folder.rglob("*")) == before


def test_what_needs_a_package_of_an_extra_later_says_so(monkeypatch):
    robot, leg = place.ROOT / "tests" / "data" / "arm.urdf", place.DEMO / "networks" / "MOB-Net-pushed-LL"
    monkeypatch.setattr(loading, "WITHOUT_TORCH", {})
    for package in ("mujoco", "onnx", "torch"):
        monkeypatch.setitem(sys.modules, package, None)
    says = r"^{} is not installed; accepted: what `\./reproduce setup` installs$"
    with pytest.raises(ConfigError, match=says.format("mujoco")):
        mobnet.Robot.read(robot)
    with pytest.raises(ConfigError, match=says.format("onnx")):
        mobnet.export_networks([leg], mobnet.Robot.read(robot.with_suffix(".yaml")), Path("made"))
    with pytest.raises(ConfigError, match=says.format("torch")):
        loading.load_network(leg)

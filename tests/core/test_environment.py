"""Every process of the project runs one thread and writes inside the project."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from mobnet.core.environment import CACHES, child_environment, fault_of_place, quieten


def test_caches_lie_inside_the_project_and_each_process_has_one_thread(tmp_path: Path) -> None:
    variables = child_environment(tmp_path)
    for name in CACHES.keys() - {"TMPDIR"}:
        assert Path(variables[name]).is_relative_to(tmp_path)
        assert Path(variables[name]).is_dir()
    assert {value for name, value in variables.items() if name.endswith("_NUM_THREADS")} == {"1"}
    assert "TMPDIR" not in child_environment(tmp_path / ("long" * 20)), "too long for the path of a socket"


@pytest.mark.parametrize("sign", ':{}"\\\n')
def test_a_path_with_a_sign_of_other_tools_is_not_accepted(sign: str) -> None:
    assert fault_of_place(Path("/place/it's a [copy] ü")) is None
    assert "is not accepted in the path" in str(fault_of_place(Path(f"/place/a{sign}b")))


def test_what_a_user_set_stays(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "environ", {"OMP_NUM_THREADS": "4"})
    quieten(tmp_path)
    assert os.environ["OMP_NUM_THREADS"] == "4"
    assert os.environ["WANDB_MODE"] == "offline"


IMPORT_ALL = """import importlib, logging, os, pkgutil, sys
written, before = [], dict(os.environ)
changes = os.O_WRONLY | os.O_RDWR | os.O_CREAT


def note(event, arguments):
    if event == "os.mkdir" or (event == "open" and arguments[2] & changes):
        written.append(str(arguments[0]))


sys.addaudithook(note)
import mobnet, numba

for module in pkgutil.walk_packages(mobnet.__path__, "mobnet."):
    importlib.import_module(module.name)
cache = os.path.dirname(os.environ["NUMBA_CACHE_DIR"])
assert numba.config.CACHE_DIR == os.environ["NUMBA_CACHE_DIR"], numba.config.CACHE_DIR
assert dict(os.environ) == before, set(os.environ.items()) ^ set(before.items())
assert not logging.getLogger().handlers
outside = [name for name in written if name.startswith("/") and not name.startswith((cache, os.devnull))]
assert not outside, outside
"""


@pytest.mark.slow
def test_importing_changes_nothing(tmp_path: Path) -> None:
    """All modules: no variable, no setting, no log, no file but in the caches of other packages."""
    environment = {**os.environ, **child_environment(tmp_path)}
    subprocess.run([sys.executable, "-B", "-c", IMPORT_ALL], check=True, env=environment)


def test_module_needs_the_standard_library_only() -> None:
    code = "import sys; sys.path.insert(0, 'src'); import mobnet.core.environment"
    subprocess.run([sys.executable, "-I", "-S", "-c", code], check=True)

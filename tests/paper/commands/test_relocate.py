"""Commands of an environment find the Python beside them and drop the packages that other software names."""

import ast
import os
import subprocess
from pathlib import Path

import pytest

from experiments.commands.install import ACTIVATED, HEADER, relocate

BODY = "# -*- coding: utf-8 -*-\nprint('never run')\n"
HEADERS = {
    "plain": "#!/somewhere/.venv/bin/python3\n",
    "spaces": "#!/bin/sh\n'''exec' \"/some where/.venv/bin/python\" \"$0\" \"$@\"\n' '''\n",
    "relative": "#!/bin/sh\n'''exec' \"$(dirname -- \"$(realpath -- \"$0\")\")\"/'python' \"$0\" \"$@\"\n' '''\n",
}


@pytest.fixture
def venv(tmp_path):
    """An environment whose Python tells what it was called with."""
    folder = tmp_path / 'it\'s a "place"' / "bin"
    folder.mkdir(parents=True)
    (folder / "python").write_text('#!/bin/sh\necho "$0|$1|$2|$PYTHONPATH"\n')
    (folder / "activate").write_text('VIRTUAL_ENV="$(dirname "$(dirname "$SCRIPT_PATH")")"\n')
    (folder / "binary").write_bytes(b"\x7fELF\xff")
    for name, header in HEADERS.items():
        (folder / name).write_text(header + BODY)
    for path in folder.iterdir():
        path.chmod(0o755)
    return folder.parent


@pytest.mark.parametrize("name", HEADERS)
def test_a_command_calls_the_python_beside_it(venv, name):
    cached = venv.with_name("cached")
    os.link(venv / "bin" / name, cached)  # as uv does with its cache
    relocate(venv)
    moved = venv.rename(venv.with_name("moved"))
    command = moved / "bin" / name
    assert command.read_text() == HEADER + BODY
    assert ast.get_docstring(ast.parse(command.read_text())) is not None, "a text for Python"
    environment = {**os.environ, "PYTHONPATH": "/opt/ros"}
    done = subprocess.run([command, "a b"], capture_output=True, text=True, check=True, env=environment)
    assert done.stdout == f"{moved}/bin/python|{command}|a b|\n"
    assert cached.read_text() == HEADERS[name] + BODY


@pytest.mark.parametrize("given", [{}, {"XDG_CACHE_HOME": "/mine", "MPLCONFIGDIR": "/mine"}])
def test_caches_of_a_command_lie_beside_the_environment_unless_a_user_says_where(venv, given):
    (venv / "bin" / "python").write_text('#!/bin/sh\necho "$XDG_CACHE_HOME|$MPLCONFIGDIR"\n')
    relocate(venv)
    environment = {name: value for name, value in os.environ.items() if name not in ("XDG_CACHE_HOME", "MPLCONFIGDIR")}
    done = subprocess.run([venv / "bin" / "plain"], capture_output=True, text=True, check=True, env=environment | given)
    xdg, drawn = (Path(path).resolve() for path in done.stdout.strip().split("|"))
    cache = venv.parent / ".cache"
    assert (xdg, drawn) == ((Path("/mine"),) * 2 if given else (cache / "xdg", cache / "matplotlib"))


def test_other_files_stay(venv):
    relocate(venv)
    assert (venv / "bin" / "binary").read_bytes() == b"\x7fELF\xff"
    assert (venv / "bin" / "python").read_text().startswith('#!/bin/sh\necho "$0')


def test_activation_unsets_foreign_packages_with_a_word(venv):
    relocate(venv)
    script = "export PYTHONPATH=/opt/ros; . bin/activate; echo ${PYTHONPATH-none}; . bin/activate"
    done = subprocess.run(["sh", "-c", script], cwd=venv, capture_output=True, text=True, check=True)
    assert done.stdout == "none\n"
    assert done.stderr.count("PYTHONPATH is unset") == 1
    assert ACTIVATED in (venv / "bin" / "activate").read_text()

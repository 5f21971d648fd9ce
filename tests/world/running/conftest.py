"""Commands as a user with empty folders runs them, seen from below: what they write elsewhere, and whom they call."""

import os
import re
import subprocess
from pathlib import Path

import c_library
import pytest

from mobnet.core.code import ROOT

OWN = ("HOME", "XDG_CACHE_HOME", "XDG_CONFIG_HOME", "XDG_DATA_HOME", "XDG_STATE_HOME", "XDG_RUNTIME_DIR", "TMPDIR")


@pytest.fixture(scope="session")
def watching(tmp_path_factory):
    """The library that is loaded into each process; none where nothing compiles it."""
    if not c_library.HAS_COMPILER:
        return None
    path = tmp_path_factory.mktemp("watch") / "watch.so"
    source = Path(__file__).with_name("watch.c")
    words = ["cc", "-shared", "-fPIC", "-Wall", "-Wextra", "-Werror", "-o", str(path), str(source), "-ldl"]
    subprocess.run(words, check=True)
    return path


@pytest.fixture
def watched(watching, tmp_path):
    """Return a function that runs a command, and returns what it wrote elsewhere and whom it called.

    The command gets empty folders in place of a user's own, and the variables that are given. It may write into the
    project, as caches of compiled code, and into the folder in which it runs; temporary files may come and go.
    """

    def run(*words, folder=tmp_path, **variables):
        places, seen = {name: tmp_path / "user" / name for name in OWN}, tmp_path / "seen"
        for place in places.values():
            place.mkdir(parents=True, exist_ok=True)
        seen.write_text("")
        own = {"WATCHED": str(seen), "PATH": os.environ["PATH"], "PYTHONDONTWRITEBYTECODE": "1"}
        preload = {"LD_PRELOAD": str(watching)} if watching else {}
        given = {**variables, **{name: str(place) for name, place in places.items()}, **own, **preload}
        done = subprocess.run([*map(str, words)], cwd=folder, env=given, capture_output=True, text=True, check=False)
        told = re.findall(r"^(write|net) (.*)$", seen.read_text(), re.MULTILINE)
        left = [str(path) for place in places.values() for path in place.rglob("*")]
        allowed = tuple(f"{os.path.realpath(place)}/" for place in (folder, ROOT, places["TMPDIR"], "/dev", "/proc"))
        written = [os.path.realpath(path) for kind, path in told if kind == "write"]
        outside = [path for path in written if not f"{path}/".startswith(allowed)]
        return done, sorted({*left, *outside}), [name for kind, name in told if kind == "net"]

    return run

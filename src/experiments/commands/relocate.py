"""An environment that holds no path of its folder, and that takes in no packages of others."""

import re
from pathlib import Path

# Read by sh: go on in the Python beside this file, without the packages that other software names, as ROS does in every
# shell, and with caches beside the environment, as Snakemake makes one before it reads the Snakefile. Read by Python: a
# text that is not used.
HEADER = """#!/bin/sh
'''unset' PYTHONPATH PYTHONHOME; caches="$(dirname -- "$(realpath -- "$0")")/../../.cache"
export XDG_CACHE_HOME="${XDG_CACHE_HOME:-$caches/xdg}" MPLCONFIGDIR="${MPLCONFIGDIR:-$caches/matplotlib}"
exec "$(dirname -- "$(realpath -- "$0")")/python" "$0" "$@"
' '''
"""
OTHER_HEADERS = re.compile(r"#!.*python.*\n|#!/bin/sh\n'''exec'.*\n' '''\n")
ACTIVATED = """
if [ -n "${PYTHONPATH-}" ]; then
    echo "PYTHONPATH is unset in this shell: its packages must not be mixed with those of .venv" >&2
    unset PYTHONPATH
fi
"""


def relocate(venv: Path) -> None:
    """Make an environment's commands and its `activate` find the folder in which they are."""
    for path in (venv / "bin").iterdir():
        with path.open("rb") as handle:
            is_script = handle.read(2) == b"#!"
        if is_script:
            replace(path, OTHER_HEADERS.sub(HEADER.replace("\\", r"\\"), path.read_text(), count=1))
    activate = venv / "bin" / "activate"
    text = activate.read_text().replace(
        '"$SCRIPT_PATH"', '"${SCRIPT_PATH:-.venv/bin/activate}"'
    )  # plain sh knows no path
    replace(activate, text + ACTIVATED)


def replace(path: Path, text: str) -> None:
    """Write a file anew under its name and its mode: a package's file may be shared with uv's cache."""
    mode = path.stat().st_mode
    path.unlink()
    path.write_text(text)
    path.chmod(mode)

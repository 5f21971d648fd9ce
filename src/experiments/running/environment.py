"""What every process of the project inherits: one thread each, caches inside the project, nothing sent anywhere.

Standard library only: `reproduce` reads it before anything is installed.
"""

import os
import re
import shlex
import shutil
import sys
import time
from importlib.metadata import version
from pathlib import Path

from mobnet.core.files import PARTIAL, discard
from mobnet.core.libraries import drop_foreign_libraries

REFUSED = re.compile(r'[:{}"\\\x00-\x1f]')  # in the project's path: a colon parts PATH, others are signs for tools
WRITTEN = ("results", "tables", "figures", "paper", "docs/results")  # folders in which jobs and a snapshot write
SCRIPTS = Path(".snakemake") / "scripts"  # what Snakemake runs in a job, removed with the end of the job
TEMPORARY = Path(".cache") / "tmp"
DAY_S = 86_400
ANY = "[a-z0-9_]" * 8  # what tempfile puts into the name of a file
LONGEST_TEMPORARY = 70  # characters; the path of a Unix socket below it must not pass 108
OLDEST = "9.25"  # Snakemake that reads the rules
IN_VENV = "`./reproduce setup` and `. .venv/bin/activate`, then the same words"
THREADED = ("OMP", "OPENBLAS", "MKL", "NUMEXPR", "NUMBA")
CACHES = {
    "XDG_CACHE_HOME": "xdg",
    "XDG_DATA_HOME": "data",
    "NUMBA_CACHE_DIR": "numba",
    "MPLCONFIGDIR": "matplotlib",
    "PIP_CACHE_DIR": "pip",
    "UV_CACHE_DIR": "uv",
    "WANDB_CACHE_DIR": "wandb/cache",
    "WANDB_CONFIG_DIR": "wandb/config",
    "WANDB_DATA_DIR": "wandb/data",
    "TEXMFVAR": "texmf",
    "TORCHINDUCTOR_CACHE_DIR": "inductor",  # a folder that torch makes even where it compiles nothing
    "RUSTUP_HOME": "rustup",  # pip asks `rustc` for its version, which then makes its home
    "TMPDIR": "tmp",
}
FIXED = {
    "PYTHONNOUSERSITE": "1",
    "PYTHONHASHSEED": "0",
    "PYTHONUTF8": "1",
    "WANDB_MODE": "offline",
    "WANDB_SILENT": "true",
    "WANDB_ERROR_REPORTING": "false",
    "DO_NOT_TRACK": "1",
    "ORT_DISABLE_TELEMETRY": "1",  # ONNX Runtime reports to its maker unless it finds this when it is imported
}


def child_environment(root: Path) -> dict[str, str]:
    """Return the variables for a project folder, and make the cache folders they name."""
    places = {name: root / ".cache" / folder for name, folder in CACHES.items()}
    if len(str(places["TMPDIR"])) > LONGEST_TEMPORARY:
        del places["TMPDIR"]
    for place in places.values():
        place.mkdir(parents=True, exist_ok=True)
    threads = {f"{name}_NUM_THREADS": "1" for name in THREADED}
    return {**threads, **{name: str(place) for name, place in places.items()}, **FIXED}


def quieten(root: Path) -> None:
    """Give this process, and so its children, the variables it does not have, and take foreign libraries from them."""
    drop_foreign_libraries()
    for name, value in child_environment(root).items():
        os.environ.setdefault(name, value)


def fault_of_place(root: Path) -> str | None:
    """Return why a project cannot be worked with in its folder: a character that other tools do not take as it is."""
    match = REFUSED.search(str(root))
    return match and f"{root}: {match[0]!r} is not accepted in the path of the project; move it to another folder"


def fault_of_process(root: Path) -> str | None:
    """Return why this Python must not run a project: it, and so its jobs, would take code from elsewhere.

    The caller has put the project's `src` into `sys.path`, before all places of packages.
    """
    source = root / "src"
    foreign = [place for place in os.environ.get("PYTHONPATH", "").split(os.pathsep) if place and Path(place) != source]
    if foreign:
        return (
            f"PYTHONPATH: {foreign[0]!r} holds packages of other software; accepted: `unset PYTHONPATH`, or ./reproduce"
        )
    places = [Path(place) for place in sys.path]
    if source in places:
        places.remove(source)
    place_of_other = next((place for place in places if (place / "mobnet" / "__init__.py").is_file()), None)
    if place_of_other is not None and place_of_other.resolve() == source.resolve():
        return fault_of_place(root)
    if place_of_other is None:
        return f"{this_snakemake()} runs this file without the packages of the project; accepted: {IN_VENV}"
    remedy = f"`cd {shlex.quote(str(root))}; ./reproduce setup; . .venv/bin/activate`"
    return f"{sys.executable}: runs {place_of_other} in place of {source}; accepted: {remedy}"


def fault_of_snakemake() -> str | None:
    """Return why this Snakemake must not run a project: it is older than the oldest that does."""
    from snakemake.exceptions import WorkflowError
    from snakemake.utils import min_version

    try:
        min_version(OLDEST)
    except WorkflowError:
        return f"{this_snakemake()} is too old; accepted: {OLDEST} and later, or {IN_VENV}"
    return None


def this_snakemake() -> str:
    """Return the version of the Snakemake that reads the rules, and its environment."""
    return f"snakemake {version('snakemake')} of {sys.prefix}"


def sweep_project(root: Path) -> None:
    """Remove what a killed run left unfinished in a project's folder; jobs that outlived it may still be writing."""
    left = list((root / SCRIPTS).glob("*"))
    # Snakemake's own cache of sources. A dry run may stand beside this one, and none lasts a day.
    left += [path for path in (root / TEMPORARY).glob("snakemake*") if path.stat().st_mtime < time.time() - DAY_S]
    for folder in WRITTEN:
        left += (root / folder).glob(f"**/{PARTIAL}{ANY}.*")
    for path in left:
        if path.is_dir():
            shutil.rmtree(path, ignore_errors=True)
        else:
            discard(path)

"""`.venv`: exactly the packages of environment.lock, made once, and made again where it is not whole.

It holds no path of this folder, so that a copied or moved folder runs its own code at once. What is checked at every
start is in its file `installed`: the hash of the lock, the build of torch, and the packages by the folders that list
their files.
"""

import fcntl
import hashlib
import os
from collections.abc import Iterator
from pathlib import Path

from experiments.commands.clean import remove, sizes_of
from experiments.commands.install import CONSTRAINTS, costs, install, make_venv, wanted_build
from experiments.commands.tell import in_gb, say
from experiments.commands.tools import LOG, Tools
from experiments.running.one_run import held_folder
from mobnet.core.files import taken
from mobnet.core.heartbeat import heartbeat

LOCKS = ("environment.lock", CONSTRAINTS)
STAMP = "installed"
CODE = "../../../../src"  # of this project, from site-packages; a copied environment finds the copy's


def set_up(root: Path, build: str | None = None) -> None:
    """Make `.venv` hold exactly environment.lock, with a build of torch if one is named, unless it does already.

    Raises:
        CommandError: the machine lacks something; the line says what.
    """
    # Without the lock, so that commands side by side do not wait for each other: the stamp of a whole one comes last.
    if fault_of(root, build) is None:
        return
    (root / ".cache").mkdir(exist_ok=True)
    with (root / ".cache" / "setup.lock").open("w") as handle:
        os.set_inheritable(handle.fileno(), True)  # what a killed set-up started holds it until it ends
        wait_for(handle.fileno())
        fault = fault_of(root, build)
        if fault is not None:  # nobody has made it meanwhile
            with held_folder(root, ["setup"]):  # a run that goes on would lose its packages
                make(root, fault, build)


def wait_for(handle: int) -> None:
    """Take the lock of the set-up; wait, and say so, while another set-up in this folder holds it."""
    if not taken(handle):
        say("waiting for another set-up in this folder to end")
        with heartbeat(lambda: "reproduce: waiting"):
            fcntl.flock(handle, fcntl.LOCK_EX)


def make(root: Path, fault: str, build: str | None) -> None:
    """Make `.venv` anew; its stamp comes last, so that a set-up that was stopped is begun again."""
    venv = root / ".venv"
    chosen = build or installed_build(root) or wanted_build()
    needed = costs(root, chosen, is_asked=build is not None)
    say(f"{fault}: .venv is made from environment.lock; this takes {needed}, once")
    (venv / STAMP).unlink(missing_ok=True)
    remove(venv)
    remove(root / LOG)
    tools = Tools.find(root)
    make_venv(tools)
    installed = install(tools, chosen, is_asked=build is not None)
    site = site_packages(root)
    (site / "mobnet.pth").write_text(f"{CODE}\n")
    packages = sorted(path.name for path in site.glob("*.dist-info"))
    (venv / STAMP).write_text("\n".join([f"{lock_hash(root)} {installed}", *packages]))
    say(f"environment is ready; it takes {in_gb(sum(sizes_of(venv, root / '.cache')))} with its cache")


def fault_of(root: Path, build: str | None) -> str | None:
    """Return why `.venv` has to be made, None where it is whole."""
    venv = root / ".venv"
    stamp = root / ".venv" / STAMP
    if not (venv / "bin" / "python").exists():
        return "there is no environment yet" if not venv.exists() else "the Python of .venv is gone"
    if not stamp.exists():
        return "the last set-up did not end"
    digest, *packages = stamp.read_text().split("\n")
    if digest.split()[0] != lock_hash(root):
        return "environment.lock has changed"
    if build not in (None, installed_build(root)):
        return f"--{build} is asked for, and .venv has the build {installed_build(root)}"
    return next((f"{name} is missing in .venv" for name in missing(site_packages(root), packages)), None)


def installed_build(root: Path) -> str:
    """Return the build of torch that a whole `.venv` had; empty without one."""
    stamp = root / ".venv" / STAMP
    return stamp.read_text().partition("\n")[0].partition(" ")[2] if stamp.exists() else ""


def lock_hash(root: Path) -> str:
    """Return the hash of what is installed."""
    return hashlib.sha256(b"".join((root / name).read_bytes() for name in LOCKS)).hexdigest()


def site_packages(root: Path) -> Path:
    """Return the folder of the environment's packages, whatever its Python is."""
    return next((root / ".venv" / "lib").glob("python3.*/site-packages"), root / ".venv" / "lib")


def missing(site: Path, packages: list[str]) -> Iterator[str]:
    """Yield files that are not there of packages, which are given by the names of their .dist-info folders."""
    if not (site / "mobnet.pth").exists():
        yield "mobnet.pth"
    for package in packages:
        record = site / package / "RECORD"
        lines = record.read_text("utf-8").splitlines() if record.exists() else [f"{package}/RECORD,,"]
        yield from (f"{name} of {package.removesuffix('.dist-info')}" for name in missing_of(site, lines))


def missing_of(site: Path, lines: list[str]) -> Iterator[str]:
    """Yield files of a RECORD that are not there; listing folders takes a third of the time of asking for each file."""
    folders: dict[str, set[str]] = {}
    for line in lines:
        folder, _, name = line.rsplit(",", 2)[0].strip('"').rpartition("/")
        folders.setdefault(folder, set()).add(name)
    for folder, names in folders.items():
        there = os.listdir(site / folder) if (site / folder).is_dir() else ()
        yield from (f"{folder}/{name}" for name in sorted(names.difference(there)))

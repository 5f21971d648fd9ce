"""Packages of environment.lock, each checked by its hash: with uv where it works, else with pip."""

import os
import re
import shlex
import shutil
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from mobnet.commands.builds import BUILDS, check_disk
from mobnet.commands.relocate import relocate
from mobnet.commands.tell import NO_NETWORK, cause_of, in_gb, is_unreachable, say
from mobnet.core.errors import CommandError

UNWANTED = "triton"  # comes with torch's CUDA build, crashes beside Mesa's software renderer, and nothing here uses it
EXACT = ("--quiet", "--disable-pip-version-check", "--no-deps", "--require-hashes")
NO_PIP = "this Python has neither venv nor pip; run `apt-get install python3-venv` as root"
SAME = ", then run the same command again"


@dataclass(frozen=True)
class Tools:
    """What installs: a Python outside `.venv`, words that call its pip, and uv, which outlives `.venv` in the cache."""

    root: Path
    base: str
    pip: tuple[str, ...]
    uv: Path
    settings: dict[str, str]

    @property
    def python(self) -> Path:
        """The Python of `.venv`."""
        return self.root / ".venv" / "bin" / "python"

    @classmethod
    def find(cls, root: Path) -> "Tools":
        """Find pip, and uv in the cache or through pip.

        Raises:
            CommandError: there is no pip, or it cannot install uv.
        """
        running = getattr(sys, "_base_executable", sys.executable)  # that of .venv is about to go
        base = str(Path(running).resolve())  # a new version of the system then leaves no .venv that half works
        pip = find_pip(root, base)
        pinned = pinned_lines(root, "uv")
        folder = root / ".cache" / "tools" / pinned.split()[0]
        tools = cls(root, base, pip, folder / "bin" / "uv", uv_settings(pip))
        if not succeeds(str(tools.uv), "--version"):
            only_uv = written(root, "uv.txt", pinned)
            tools.run("installing uv", *pip, "install", *EXACT, "--upgrade", "--target", str(folder), "-r", only_uv)
        return tools

    def try_to(self, *words: str) -> str | None:
        """Run a command, its output into the log of the set-up; return the output where it failed.

        Raises:
            CommandError: it failed for a reason that no other way of installing avoids.
        """
        variables = {**os.environ, **self.settings}
        done = subprocess.run(  # the lock of the set-up is inherited, so that nothing writes beside the next one
            words,
            env=variables,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            check=False,
            close_fds=False,
        )
        with (self.root / ".cache" / "setup.log").open("a") as log:
            log.write(f"$ {shlex.join(words)}\n{done.stdout}")
        if done.returncode == 0:
            return None
        if cause := cause_of(done.stdout):
            free = in_gb(shutil.disk_usage(self.root).free)
            raise CommandError(f"{self.root}: {cause}{SAME} ({free} of disk free; all output: .cache/setup.log)")
        return done.stdout

    def run(self, what: str, *words: str) -> None:
        """Run a command that has to succeed.

        Raises:
            CommandError: it failed.
        """
        output = self.try_to(*words)
        if output is not None:
            raise failed(what, output)


def failed(what: str, output: str) -> CommandError:
    """Return the error of a step, in one line."""
    if is_unreachable(output):
        return CommandError(f"{what} failed: {NO_NETWORK}{SAME}")
    last = next((line for line in reversed(output.splitlines()) if re.search("error|cause|ERROR", line)), "no output")
    return CommandError(f"{what} failed: {last.strip()} (all output: .cache/setup.log)")


def find_pip(root: Path, base: str) -> tuple[str, ...]:
    """Return the words that call a pip: that of a Python, or one in an environment in the cache.

    Raises:
        CommandError: there is none.
    """
    if succeeds(base, "-m", "pip", "--version"):
        return base, "-m", "pip"
    own = root / ".cache" / "tools" / "pip"
    if succeeds(base, "-c", "import ensurepip") and succeeds(base, "-m", "venv", "--clear", str(own)):
        return str(own / "bin" / "python"), "-m", "pip"
    raise CommandError(NO_PIP + SAME)


def make_venv(tools: Tools) -> None:
    """Make an empty `.venv` that can be moved."""
    venv = str(tools.root / ".venv")
    tools.run("making .venv", str(tools.uv), "venv", "--quiet", "--relocatable", "--python", tools.base, venv)


def install(tools: Tools, build: str, *, is_asked: bool) -> str:
    """Install the lock with a build of torch; return the build, which is CUDA where nobody offers that for CPUs.

    Raises:
        CommandError: it could not be installed.
    """
    outputs = attempt(tools, build)
    if outputs and build == "cpu" and not is_asked and not all(map(is_unreachable, outputs)):
        check_disk(tools.root, "cuda")
        size = in_gb(BUILDS["cuda"].disk)
        say(f"no index offers torch's CPU build for this Python: the CUDA build is taken, {size} in all")
        build = "cuda"
        outputs = attempt(tools, build)
    if outputs:
        raise failed("installing packages", next((o for o in outputs if not is_unreachable(o)), outputs[0]))
    tools.try_to(
        str(tools.uv), "pip", "uninstall", "--quiet", "--python", str(tools.python), UNWANTED
    )  # pip takes it in
    relocate(tools.root / ".venv")
    return build


def attempt(tools: Tools, build: str) -> list[str]:
    """Try to install a build from the cache, from pip's places, from where uv knows it, then by pip; return why not."""
    python, places = str(tools.python), BUILDS[build].places
    locked = "-r", locked_packages(tools.root, build), "-c", str(tools.root / "cuda.constraints"), "--require-hashes"
    left_out = written(tools.root, "excludes.txt", f"{UNWANTED}\nuv\n")
    uv = str(tools.uv), "pip", "install", "--quiet", "--python", python, "--excludes", left_out, *locked
    if any(tools.try_to(*uv, "--offline", *place) is None for place in places):
        return []
    check_disk(tools.root, build)
    outputs: list[str] = []
    pip = *tools.pip, "--python", python, "install", "--quiet", "--disable-pip-version-check", "--retries", "1", *locked
    for words in [*((*uv, *place) for place in places), pip]:
        output = tools.try_to(*words)
        if output is None:
            return []
        outputs.append(output)
    return outputs


def locked_packages(root: Path, build: str) -> str:
    """Write the lock with a build of torch; return the path."""
    text = (root / "environment.lock").read_text()
    versions = BUILDS[build].version
    chosen = re.sub(
        r"^torch==(\S+)", lambda found: f"torch{versions.format(version=found[1])}", text, flags=re.MULTILINE
    )
    return written(root, f"{build}.txt", chosen)


def pinned_lines(root: Path, package: str) -> str:
    """Return the lines of a package in the lock: its version and its hashes."""
    text = (root / "environment.lock").read_text()
    found = re.search(rf"^{package}==\S+ \\\n(?: +--hash\S+(?: \\)?\n)+", text, re.MULTILINE)
    if found is None:
        raise CommandError(f"environment.lock: {package} is missing")
    return found[0]


def written(root: Path, name: str, text: str) -> str:
    """Write a file for the set-up's tools into the cache; return its path."""
    path = root / ".cache" / "tools" / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    return str(path)


def uv_settings(pip: Sequence[str]) -> dict[str, str]:
    """Return pip's configuration (find-links, indexes, certificate) in the variables that uv reads."""
    listing = subprocess.run([*pip, "config", "list"], capture_output=True, text=True, check=False).stdout
    found = dict(re.findall(r"^[^\n]*?\.([a-z-]+)='([^\n]*)'$", listing, re.MULTILINE))
    names = {"find-links": "UV_FIND_LINKS", "index-url": "UV_DEFAULT_INDEX", "extra-index-url": "UV_INDEX"}
    settings = {names[key]: " ".join(value.replace("\\n", " ").split()) for key, value in found.items() if key in names}
    if "UV_FIND_LINKS" in settings:
        settings["UV_FIND_LINKS"] = settings["UV_FIND_LINKS"].replace(" ", ",")
    if "cert" in found:
        settings["SSL_CERT_FILE"] = found["cert"]
    return {
        **settings,
        "UV_SYSTEM_CERTS": "1",
        "UV_INDEX_STRATEGY": "unsafe-best-match",
        "UV_PYTHON_DOWNLOADS": "never",
        "UV_HTTP_TIMEOUT": "180",
    }


def succeeds(*words: str) -> bool:
    """Return whether a command can be run and succeeds; nothing is shown."""
    try:
        return subprocess.run(words, capture_output=True, check=False).returncode == 0
    except OSError:
        return False

"""What installs packages: a Python outside `.venv`, its pip, and uv; and how a step that failed is told."""

import os
import re
import shlex
import shutil
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Self

from experiments.commands.tell import NO_NETWORK, cause_of, in_gb, is_unreachable, say, step_of
from mobnet.core.errors import CommandError
from mobnet.core.heartbeat import heartbeat

EXACT = ("--quiet", "--disable-pip-version-check", "--no-deps", "--require-hashes")
NO_PIP = "this Python has neither venv nor pip; run `apt-get install python3-venv` as root"
SAME = ", then run the same command again"
LOG = ".cache/setup.log"


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
    def find(cls, root: Path) -> Self:
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

        A line on the terminal shows the last line of the output meanwhile.

        Raises:
            CommandError: it failed for a reason that no other way of installing avoids.
        """
        variables = {**os.environ, **self.settings}
        place = self.root / LOG
        place.parent.mkdir(parents=True, exist_ok=True)
        with place.open("a", encoding="utf-8") as log:
            log.write(f"$ {shlex.join(words)}\n")
            log.flush()
            start = log.tell()
            with heartbeat(lambda: f"reproduce: {step_of(place, start) or Path(words[0]).name}"):
                done = (
                    subprocess.run(  # the lock of the set-up is inherited, so that nothing writes beside the next one
                        words,
                        env=variables,
                        stdout=log,
                        stderr=subprocess.STDOUT,
                        text=True,
                        check=False,
                        close_fds=False,
                    )
                )
        if done.returncode == 0:
            return None
        output = place.read_bytes()[start:].decode(errors="replace")
        if cause := cause_of(output):
            free = in_gb(shutil.disk_usage(self.root).free)
            raise CommandError(f"{self.root}: {cause}{SAME} ({free} of disk free; all output: {LOG})")
        return output

    def run(self, what: str, *words: str) -> None:
        """Say what a command does, and run it; it has to succeed.

        Raises:
            CommandError: it failed.
        """
        say(what)
        output = self.try_to(*words)
        if output is not None:
            raise failed(what, output)


def failed(what: str, output: str) -> CommandError:
    """Return the error of a step, in one line."""
    if is_unreachable(output):
        return CommandError(f"{what} failed: {NO_NETWORK}{SAME}")
    last = next((line for line in reversed(output.splitlines()) if re.search("error|cause|ERROR", line)), "no output")
    return CommandError(f"{what} failed: {last.strip()} (all output: {LOG})")


def find_pip(root: Path, base: str) -> tuple[str, ...]:
    """Return the words that call a pip: that of a Python, or one in an environment in the cache.

    Raises:
        CommandError: there is none.
    """
    if succeeds(base, "-m", "pip", "--version"):
        return base, "-m", "pip"
    folder = root / ".cache" / "tools" / "pip"
    if succeeds(base, "-c", "import ensurepip") and succeeds(base, "-m", "venv", "--clear", str(folder)):
        return str(folder / "bin" / "python"), "-m", "pip"
    raise CommandError(NO_PIP + SAME)


def pinned_lines(root: Path, package: str) -> str:
    """Return the lines of a package in the lock: its version and its hashes."""
    text = (root / "environment.lock").read_text()
    match = re.search(rf"^{package}==\S+ \\\n(?: +--hash\S+(?: \\)?\n)+", text, re.MULTILINE)
    if match is None:
        raise CommandError(f"environment.lock: {package} is missing")
    return match[0]


def written(root: Path, name: str, text: str) -> str:
    """Write a file for the set-up's tools into the cache; return its path."""
    path = root / ".cache" / "tools" / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    return str(path)


def uv_settings(pip: Sequence[str]) -> dict[str, str]:
    """Return pip's configuration (find-links, indexes, certificate) in the variables that uv reads."""
    listing = subprocess.run([*pip, "config", "list"], capture_output=True, text=True, check=False).stdout
    configured = dict(re.findall(r"^[^\n]*?\.([a-z-]+)='([^\n]*)'$", listing, re.MULTILINE))
    names = {"find-links": "UV_FIND_LINKS", "index-url": "UV_DEFAULT_INDEX", "extra-index-url": "UV_INDEX"}
    settings = {
        names[key]: " ".join(value.replace("\\n", " ").split()) for key, value in configured.items() if key in names
    }
    if "UV_FIND_LINKS" in settings:
        settings["UV_FIND_LINKS"] = settings["UV_FIND_LINKS"].replace(" ", ",")
    if "cert" in configured:
        settings["SSL_CERT_FILE"] = configured["cert"]
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

"""Where the package stands: in a checkout of the project, or installed as a library.

A checkout keeps configuration and caches in its own folder. An installed package has the configuration of a lab beside
its modules (pyproject.toml says which files), and machine code in the user's cache. Standard library only.
"""

import importlib
import importlib.metadata
import os
import tomllib
from pathlib import Path
from types import ModuleType

from mobnet.core.code import ROOT
from mobnet.core.errors import ConfigError

PACKAGE = Path(__file__).parents[1]
IS_CHECKOUT = (ROOT / "reproduce").is_file()
PROGRAM = "./reproduce" if IS_CHECKOUT else "mobnet"  # what a user types before a command's name
PYTHON = ".venv/bin/python" if IS_CHECKOUT else "python"  # that has the packages
CONFIGS = ROOT / "configs" if IS_CHECKOUT else PACKAGE / "configs"
DEMO = ROOT / "docs" / "demo" if IS_CHECKOUT else PACKAGE / "demo_data"
EXTRAS = {"torch": "learn", "mujoco": "simulate", "onnx": "export", "onnxruntime": "export"}
LOGS = "logs"  # extra of all others


def caches() -> Path:
    """Return the folder of what can be made again, such as machine code."""
    if IS_CHECKOUT:
        return ROOT / ".cache"
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "mobnet"


def version() -> str:
    """Return the version of the project."""
    if not IS_CHECKOUT:
        return importlib.metadata.version("mobnet")
    return tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["version"]


def command(name: str) -> str:
    """Return how a user calls a command of a lab, such as `mobnet observe`."""
    return f"{PROGRAM} {name}"


def with_extra(name: str) -> ModuleType:
    """Import a module of this package by its full name.

    Raises:
        ConfigError: a package that it needs is not installed; the line says how to install it.
    """
    try:
        return importlib.import_module(name)
    except ModuleNotFoundError as error:
        package = str(error.name).partition(".")[0]
        if package == "mobnet":
            raise
        remedy = "./reproduce setup" if IS_CHECKOUT else f"pip install 'mobnet[{EXTRAS.get(package, LOGS)}]'"
        raise ConfigError(f"{package} is not installed; accepted: what `{remedy}` installs") from None

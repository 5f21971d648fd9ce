"""Modules of packages that only some commands need, and the extra of this package that brings each."""

import importlib
from types import ModuleType

from mobnet.core.errors import ConfigError
from mobnet.core.place import IS_CHECKOUT

EXTRAS = {"torch": "learn", "mujoco": "simulate", "onnx": "export", "onnxruntime": "export"}
LOGS = "logs"  # extra of all others


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

"""Where the package stands: in a checkout of the project, or installed as a library.

A checkout keeps configuration in its own folder. An installed package has the configuration of a lab beside its modules
(pyproject.toml says which files). Standard library only.
"""

import importlib.metadata
import importlib.util
import tomllib
from pathlib import Path

from mobnet.core.errors import ConfigError
from mobnet.core.root import IS_CHECKOUT, ROOT

PACKAGE = Path(__file__).parents[1]
PROGRAM = "./reproduce" if IS_CHECKOUT else "mobnet"  # what a user types before a command's name
CONFIGS = ROOT / "configs" if IS_CHECKOUT else PACKAGE / "configs"
DEMO = ROOT / "docs" / "demo" if IS_CHECKOUT else PACKAGE / "demo_data"
EXTRAS = {  # extra of pyproject.toml -> its packages, by the names under which they are imported
    "learn": ("torch",),
    "simulate": ("mujoco",),
    "logs": ("h5py", "matplotlib", "mcap", "mcap_ros2", "pandas", "rosbags"),
    "export": ("onnx", "onnxruntime"),
}


def version() -> str:
    """Return the version of the project."""
    if not IS_CHECKOUT:
        return importlib.metadata.version("mobnet")
    return tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["version"]


def command(name: str) -> str:
    """Return how a user calls a command of a lab, such as `mobnet observe`."""
    return f"{PROGRAM} {name}"


def check_extra(extra: str) -> None:
    """Check that the packages of an extra are installed; none of them is imported, which would take seconds.

    Raises:
        ConfigError: one is not; the line says how to install it.
    """
    for package in EXTRAS[extra]:
        if importlib.util.find_spec(package) is None:
            remedy = "./reproduce setup" if IS_CHECKOUT else f"pip install 'mobnet[{extra}]'"
            raise ConfigError(f"{package} is not installed; accepted: what `{remedy}` installs")

"""MOB-Net: limb-modularized uncertainty torque learning for sensorless external torque estimation.

The names below are the interface for programs of others (docs/interface.md); all else may change with any release. They
are loaded when they are first used: `import mobnet` costs nothing, and commands need what they use alone.
"""

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from mobnet.interface import (
        ContactFinder,
        Detector,
        Estimator,
        MobnetError,
        Observer,
        ReactionHandler,
        Robot,
        export_networks,
        read_recording,
        write_recording,
    )
    from mobnet.kernel.observer import MomentumObserver

__all__ = [
    "ContactFinder",
    "Detector",
    "Estimator",
    "MobnetError",
    "MomentumObserver",
    "Observer",
    "ReactionHandler",
    "Robot",
    "export_networks",
    "read_recording",
    "write_recording",
]

ALONE = ("MomentumObserver",)  # what needs neither configuration nor files


def __getattr__(name: str) -> Any:
    """Return a name of the interface; Python asks for those that are not there yet."""
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    module = "mobnet.kernel.observer" if name in ALONE else "mobnet.interface"
    return getattr(importlib.import_module(module), name)


def __dir__() -> list[str]:
    """Return the names of the interface."""
    return __all__

"""Shared libraries that a terminal names, and that the loader would take in place of Pinocchio's own.

A terminal in which ROS is sourced names its folders in LD_LIBRARY_PATH. The loader looks there before it looks beside a
package, and finds other versions of libraries that Pinocchio brings under the same names, such as libeigenpy.so: the
import fails, or worse, does not. Folders that hold such a name are left out. All others stay, because a machine may
need them, such as those of CUDA. Standard library only.
"""

import importlib.util
import os
from pathlib import Path

VARIABLE = "LD_LIBRARY_PATH"
IN_SITE_PACKAGES = Path("cmeel.prefix") / "lib"  # where the wheels of Pinocchio keep their libraries


def drop_foreign_libraries(ours: Path | None = None) -> bool:
    """Take folders out of this process's LD_LIBRARY_PATH; return whether there were any.

    The loader has read the variable when the process began: what changes is what its children find.

    Args:
        ours: the folder of Pinocchio's libraries, by default that of the Python that runs.
    """
    named = os.environ.get(VARIABLE)
    ours = ours or own_folder()
    if not named or ours is None:
        return False
    libraries = {path.name for path in ours.glob("*.so*")}
    places = named.split(os.pathsep)
    kept = [place for place in places if not _is_foreign(Path(place), ours, libraries)]
    os.environ[VARIABLE] = os.pathsep.join(kept)
    return kept != places


def own_folder() -> Path | None:
    """Return the folder of the libraries of the Pinocchio that this Python would import; None without one."""
    spec = importlib.util.find_spec("pinocchio")
    if spec is None or spec.origin is None:
        return None
    return Path(spec.origin).parents[3]  # lib/python3.x/site-packages/pinocchio/__init__.py


def _is_foreign(place: Path, ours: Path, libraries: set[str]) -> bool:
    """Return whether a folder is not that of our libraries and holds a file of the name of one."""
    if place.resolve() == ours.resolve():
        return False
    try:
        return not libraries.isdisjoint(os.listdir(place))
    except OSError:  # a folder that is not there
        return False

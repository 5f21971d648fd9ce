"""Files of the project's own folder, which a run reads wherever its results go."""

from pathlib import Path

from mobnet.core.code import ROOT


def in_project() -> bool:
    """Return whether the working folder is the project's, by whatever links it was reached."""
    return Path.cwd().samefile(ROOT)


def project_file(name: str | Path) -> Path:
    """Return a file of the project as a run reaches it from its working folder.

    That is the project's folder, and the name is relative, unless `--directory` names another one.
    """
    return Path(name) if in_project() else ROOT / name

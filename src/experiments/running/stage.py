"""Where a job of several parts keeps what it has made, so that one that was killed goes on with the next part.

Snakemake removes the outputs of a job that did not end. Such a job therefore writes below a folder of its own, and
moves its files to their places when the last of them is there.
"""

import os
import shutil
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from mobnet.core.errors import DataError
from mobnet.core.files import read_json, write_json

NOTE = "stage.json"


@dataclass(frozen=True)
class Stage:
    """The folder in which a job keeps its finished parts.

    Attributes:
        folder: of this job alone.
        given: hash of the job's arguments and code.
        inputs: the files that the job reads.
    """

    folder: Path
    given: str
    inputs: tuple[str, ...] = ()

    def begin(self) -> None:
        """Keep the parts of an earlier start if they were made with the same code from the same files, else none."""
        stats = {name: Path(name).stat() for name in self.inputs}
        files = {name: [stat.st_size, stat.st_mtime_ns] for name, stat in stats.items()}
        note = {"given": self.given, "inputs": files}
        if self._noted() != note:
            shutil.rmtree(self.folder, ignore_errors=True)
            write_json(self.folder / NOTE, note)

    def _noted(self) -> dict[str, object]:
        """Return what the parts that are there were made from; nothing where that cannot be read."""
        try:
            return read_json(self.folder / NOTE)
        except DataError:
            return {}

    def place(self, out: Path) -> Path:
        """Return where a file or an array of the job stands until the job ends."""
        return self.folder / out.relative_to(out.anchor)

    def has(self, files: Iterable[Path]) -> bool:
        """Return whether all files of a part are there; each was written atomically, and so is whole."""
        return all(self.place(file).exists() for file in files)

    def publish(self, files: Iterable[Path]) -> None:
        """Move all files of the job to their places, and remove the folder."""
        for file in files:
            file.parent.mkdir(parents=True, exist_ok=True)
            os.replace(self.place(file), file)
        shutil.rmtree(self.folder)

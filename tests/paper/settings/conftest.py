"""The configuration with one file changed."""

from functools import cache
from pathlib import Path

import pytest

from experiments.jobs.method_problems import method_problems
from experiments.settings import load
from experiments.settings.load import load_settings
from mobnet.formats.reading import Document

from .mutations import FILES, Load


@pytest.fixture(scope="session")
def load_with(tmp_path_factory: pytest.TempPathFactory) -> Load:
    """A function (file, its text) -> the configuration with that file; the others are read once."""
    folder, patch = tmp_path_factory.mktemp("mutated"), pytest.MonkeyPatch()
    read = cache(Document)

    def loaded(file: str, text: str) -> object:
        path = folder / FILES[file].name
        path.write_text(text)

        def document(asked: Path, *, nulls: bool = False) -> Document:
            if asked != FILES[file]:
                return read(asked, nulls=nulls)
            changed = Document(path, nulls=nulls)
            changed.path, changed.faults = asked, [fault.replace(str(path), str(asked)) for fault in changed.faults]
            return changed

        with patch.context() as patched:
            patched.setattr(load, "Document", document)
            return load_settings(further=method_problems)

    return loaded

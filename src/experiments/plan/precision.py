"""Which number format `learning.precision: auto` stands for: decided once for the results of a scale, and recorded.

The machine that starts the first run decides. A training gets the format by its name, so that it is part of what the
training is, and a node of another kind of processor makes the same network.
"""

from pathlib import Path

from experiments.settings.settings import Settings
from mobnet.core.files import read_json, write_json
from mobnet.core.notes import Note, checked
from mobnet.learning.precision import AUTO, Precision, in_precision, of_processor

PLACE = Path("state") / "precision.json"  # below the results of a scale


class PrecisionNote(Note):
    """The file in which the format is recorded."""

    auto: Precision


def with_precision(settings: Settings, results: Path) -> Settings:
    """Return the settings with a number format in place of every `auto`: the recorded one, or else this machine's.

    Raises:
        DataError: the record is damaged.
    """
    name = _recorded(results) or of_processor()
    methods = {
        method: row.model_copy(update={"learning": {**row.learning, "precision": name}})
        for method, row in settings.methods.items()
        if row.learning.get("precision") == AUTO
    }
    learning = in_precision(settings.learning, name)
    return settings.model_copy(update={"learning": learning, "methods": {**settings.methods, **methods}})


def record_precision(results: Path) -> None:
    """Record what `auto` stands for in the results of a scale, if it is not recorded yet."""
    if _recorded(results) is None:
        write_json(results / PLACE, {"auto": of_processor()})


def _recorded(results: Path) -> Precision | None:
    """Return the recorded format, if there is one."""
    path = results / PLACE
    return checked(path, read_json(path), PrecisionNote).auto if path.exists() else None

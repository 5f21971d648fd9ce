"""What was fixed before a run: claims, robots, methods, detectors and tolerances, as one fingerprint for each.

`python -m experiments.site.registered` writes docs/registered.json, in a commit before the run whose
results these parts judge. A fingerprint leaves out words, so that English can be mended afterwards, and nothing else.
A snapshot holds the fingerprints of its run; a test compares.
"""

import hashlib
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any, cast

from experiments.settings.load import load_settings
from experiments.settings.settings import Settings
from mobnet.core.code import commit_of
from mobnet.core.errors import DataError
from mobnet.core.files import read_json, write_json

REGISTERED = Path("docs/registered.json")
SCALE = "default"  # whose results are published
WORDS = {"says", "printed", "caption", "title", "titles", "label", "labels", "header", "names"}  # keys of words
DIGITS = 16  # of a fingerprint, enough to tell two texts apart


def main() -> None:
    """Write the fingerprints of the configuration of the published scale."""
    write_json(REGISTERED, fingerprints(load_settings(overrides={"scale": SCALE})))


def fingerprints(settings: Settings) -> dict[str, str]:
    """Return part of the configuration -> fingerprint of all that it holds but words."""
    whole = settings.model_dump(mode="json")
    evaluation = cast("Mapping[str, Any]", whole["evaluation"])
    parts: dict[str, object] = {
        "claims": whole["claims"],
        "robots": [whole["surrogate"], whole["fleet"], whole["levels"]],
        "methods": [whole["methods"], whole["networks"], whole["sweeps"]],
        "detectors": [whole["detection"], whole["reaction"]],
        "tolerances": evaluation["statistics"],
        "sizes": [whole["scales"][SCALE], whole["training_sets"], whole["seed"]],
    }
    return {name: fingerprint(part) for name, part in parts.items()}


def fingerprint(part: object) -> str:
    """Return a fingerprint of a value of JSON without its words."""
    text = json.dumps(without_words(part), sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()[:DIGITS]


def without_words(part: object) -> object:
    """Return a value of JSON without the keys that hold words alone."""
    if isinstance(part, Mapping):
        pairs = cast("Mapping[str, object]", part)
        return {key: without_words(value) for key, value in pairs.items() if key not in WORDS}
    if isinstance(part, list):
        return [without_words(each) for each in cast("list[object]", part)]
    return part


def registered() -> dict[str, str]:
    """Return the fingerprints that were registered."""
    return cast("dict[str, str]", read_json(REGISTERED))


def check_registered(settings: Settings) -> None:
    """Check that the configuration is the registered one, words apart.

    Raises:
        DataError: a part differs.
    """
    now = fingerprints(settings)
    before = registered()
    changed = [name for name in now if now[name] != before.get(name)]
    if changed:
        raise DataError(
            f"{REGISTERED}: {', '.join(changed)} differ from configs; accepted: what was registered before the run, "
            f"by python -m {__spec__.name}"
        )


def registration() -> dict[str, str]:
    """Return the commit that registered last, and what it did, as the note of published results holds them."""
    return {"commit": commit_of(REGISTERED), **registered()}


if __name__ == "__main__":
    main()

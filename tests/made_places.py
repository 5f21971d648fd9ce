"""Made-up files at the places of a plan, with notes that fit them."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

from mobnet.plan.runs import Files

SCENARIO, LEVEL = "walk_test", "all_uncertainty"
Change = Callable[[dict[str, Any]], Any]


def estimated(files: Files) -> tuple[str, ...]:
    """Return the joints of which the walk has estimates."""
    return files.catalogue.estimated("MOB", SCENARIO, LEVEL)


def note_of(files: Files, kind: str, **more: Any) -> tuple[Path, dict[str, Any]]:
    """Return the place of the note of a walk's array, and a sound note."""
    seed = files.test_seeds[0]
    names = {"recordings": ["q.LL1"], "residuals": ["r.LL1"]}.get(kind)
    if names is None:
        names = [f"{signal}.{joint}" for signal in ("tau_ext", "std") for joint in estimated(files)]
    columns = [{"name": name, "unit": "-", "frame": "-"} for name in names]
    note = {"rows": 10000, "segments": [[0, 10000]], "rate_hz": 1000.0, "scenario": SCENARIO, "level": LEVEL}
    note |= {"seed": seed, "falls": 0, "columns": columns, **more}
    return files.array(kind, SCENARIO, LEVEL, seed).with_suffix(".json"), note


def written(path: Path, note: object) -> Path:
    """Write a note."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(note))
    return path

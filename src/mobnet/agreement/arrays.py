"""Notes of recordings, residuals and estimates against their places, the configuration, and the recording."""

import functools
import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from mobnet.agreement.said import differences
from mobnet.core.columns import EXTERNAL, RESIDUAL, STD, named
from mobnet.core.errors import not_accepted
from mobnet.core.files import WEIGHTS
from mobnet.core.notes import note_differences, read_array_note
from mobnet.core.store import ARRAY, NOTE, file_of
from mobnet.learning.deployed.weights import std_scales
from mobnet.plan.runs import Files

NAMES = re.compile(r"s(\d+)\.(parquet|json)")
POSITIONS = "q"
SIGNALS = {"recordings": POSITIONS, "residuals": RESIDUAL, "estimates": EXTERNAL}  # that only such an array has


def array_faults(path: Path, place: tuple[str, ...], files: Files) -> Iterator[str]:
    """Yield in what the note of a recording, residual or estimate is not that of its place."""
    if len(place) != (6 if place[0] == "estimates" else 4):
        return
    kind, *owner, scenario, level, name = place
    found, settings = NAMES.fullmatch(name), files.settings
    if not found or path.suffix == ARRAY or scenario not in settings.scenarios or level not in settings.levels:
        return
    if kind == "estimates":
        yield from _run_faults(owner, scenario, level, files)
    note = read_array_note(path)
    signals = {column["name"].partition(".")[0] for column in note["columns"]}
    if SIGNALS[kind] not in signals or (kind != "recordings" and POSITIONS in signals):
        yield not_accepted("columns", sorted(signals), [f"those of {kind}"])
        return
    said = {"scenario": scenario, "level": level, "seed": int(found[1]), "rate_hz": settings.rates.data_hz}
    if kind == "residuals":
        ratio = settings.levels[level].nominal_mass_ratio
        said |= {"gain_hz": settings.observer.gain_hz, "nominal_mass_ratio": ratio}
    if owner and owner[0] in files.catalogue.all_methods:
        yield from _owner_faults(note, owner[0], int(owner[1].removeprefix("n")), (scenario, level), files)
    yield from differences(note, said)
    if kind == "recordings":
        yield from _recording_faults(note, scenario, level, int(found[1]), files)
    recording = files.array("recordings", scenario, level, found[1])
    if kind != "recordings" and file_of(recording, NOTE).exists():
        other = read_array_note(file_of(recording, NOTE))
        yield from note_differences(note, other, f"{recording}{NOTE}, its recording")


def _run_faults(owner: Sequence[str], scenario: str, level: str, files: Files) -> Iterator[str]:
    """Yield what no job has in the folders of an estimate: method, n with a network seed, scenario, level."""
    method, seed, settings = owner[0], owner[1].removeprefix("n"), files.catalogue
    if method not in settings.all_methods:
        yield not_accepted("folder of the method", method, settings.all_methods)
        return
    seeds = [str(number) for number in files.network_seeds(method)]
    if seed not in seeds:
        yield not_accepted(f"folder of the seed of {method}", owner[1], [f"n{number}" for number in seeds])
    if method not in settings.tests.get(scenario, {}).get(level, ()):
        tests = [f"{test}/{of}" for test, levels in settings.tests.items() for of in levels if method in levels[of]]
        yield not_accepted(f"folder of the test of {method}", f"{scenario}/{level}", tests)


def _recording_faults(note: Mapping[str, Any], scenario: str, level: str, seed: int, files: Files) -> Iterator[str]:
    """Yield terrains and self-collisions that cannot be, and samples that are missing where no robot fell."""
    collisions, nearest = note.get("self_collisions", 0), note.get("clearance_min_m", 0.0)
    if (collisions > 0 and nearest > 0.0) or (collisions == 0 and nearest < 0.0):
        yield not_accepted("self_collisions", collisions, [f"those of a clearance_min_m of {nearest}"])
    for terrain in note.get("terrains", ()):
        if terrain not in files.settings.scenarios[scenario].terrain:
            yield not_accepted("terrains", terrain, files.settings.scenarios[scenario].terrain)
    if (scenario, level, seed) in files.recorded() and note.get("falls", 1) == 0:
        rows = round(files.duration_s([scenario], seed) * files.settings.rates.data_hz)
        held = sum(end - start for start, end in note["segments"])
        if not rows == note["rows"] == held:
            text = f"{note['rows']} rows, {held} in segments"
            yield not_accepted("rows", text, [f"{rows}, all of them in segments, as no robot fell"])


def _owner_faults(
    note: Mapping[str, Any], method: str, seed: int, test: tuple[str, str], files: Files
) -> Iterator[str]:
    """Yield in what the note of an estimate is not that of a method and a network seed in a test at a level."""
    folders = files.networks(method, seed, *test)
    yield from differences(note, {"method": method, "networks": {limb: path.name for limb, path in folders.items()}})
    joints = files.catalogue.estimated(method, *test)
    expected = {*named(EXTERNAL, joints), *(named(STD, joints) if folders else ())}
    held = {column["name"] for column in note["columns"]}
    for name in sorted(expected ^ held):
        word = "is missing" if name in expected else "is too much"
        yield f"columns: {name!r} {word}; accepted: those of {method}, {', '.join(sorted(expected)[:3])}, ..."
    weights = tuple(folder / WEIGHTS for folder in folders.values())
    scales = note.get("std_scale", {})
    if all(path.exists() for path in weights) and scales != (known := _std_scales(weights)):
        yield not_accepted("std_scale", scales, [f"{known}, of its networks"])


@functools.cache
def _std_scales(weights: tuple[Path, ...]) -> dict[str, float]:
    """Return what `std_scales` does of networks that many estimates share."""
    return std_scales(weights)

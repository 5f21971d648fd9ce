"""The published page of pushes, written again from the recordings that it holds: where its words alone changed.

`python -m experiments.evaluation.report.explore_again` renews explore.html in docs/results. Its arrays and scenes stay,
and so do the numbers that the page had; `provenance.json` says that it was written after the run.
"""

import base64
import gzip
import json
import logging
import re
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from experiments.evaluation.measure.push_scene import PushScene
from experiments.evaluation.report.explore import FLAGS, OBSERVER, is_whole, page_numbers, page_with
from experiments.evaluation.report.snapshot import SNAPSHOT, note_renewal, run_renewal
from experiments.plan.products import TEMPLATES
from experiments.settings.load import load_settings
from experiments.settings.settings import Settings
from mobnet.core.errors import DataError
from mobnet.core.files import read_text, write_text
from mobnet.robot.description import describe

log = logging.getLogger(__name__)
PAGE = "explore.html"
AGAIN = "written after the run from the recordings that it holds"  # what the note of a snapshot says
TOLD = re.compile(r'<script type="application/json" id="told">(.*?)</script>', re.DOTALL)
DATA = re.compile(r'<script type="text/plain" id="data">(.*?)</script>', re.DOTALL)
ROW = re.compile(r'<tr data-method="([^"]+)">(.*?)</tr>', re.DOTALL)
CELL = re.compile(r"<td[^>]*>(.*?)</td>", re.DOTALL)
KEPT = (0, 1, 3)  # cells of a row that no wording changes: peak, share and error in the push


def explore_again(settings: Settings, published: Path, template: Path) -> None:
    """Write the page of pushes in a folder of published results again, by the present template.

    Raises:
        DataError: the page is missing or damaged, or a number of its tables would change.
    """
    path = published / PAGE
    page = read_text(path)
    found = [pattern.search(page) for pattern in (TOLD, DATA)]
    if None in found:
        raise DataError(f"{path}: its recordings are missing; accepted: a page that `./reproduce snapshot` stored")
    text, data = (match[1] for match in found if match)
    told = json.loads(text)
    scenes = scenes_of(told, data)
    whole = settings.evaluation
    told["settings"] = page_numbers(whole.explore, settings.detection, whole.peaks, whole.story)
    robot = describe(settings.robot)
    again = page_with(told, data, scenes, whole.story, settings.detection, whole.peaks, robot, template)
    if kept_cells(again) != kept_cells(page):
        raise DataError(f"{path}: numbers of its tables would change; ./reproduce snapshot stores the page of a run")
    write_text(path, again)
    note_renewal(published, "explore", AGAIN)
    log.info("%s: written again", path)


def kept_cells(page: str) -> list[tuple[str, ...]]:
    """Return of each row of the page's tables the method, and the numbers that no wording changes."""
    rows: list[tuple[str, ...]] = []
    for method, text in ROW.findall(page):
        cells = [cell.strip() for cell in CELL.findall(text)]
        rows.append((method, *(cells[place] for place in KEPT)))
    return rows


def scenes_of(told: Mapping[str, Any], data: str) -> dict[str, PushScene]:
    """Return name -> the push of each scene of a page, with torques as it has them; poses and forces are empty."""
    rest = gzip.decompress(base64.b64decode(data))
    scenes: dict[str, PushScene] = {}
    for note in told["scenes"]:
        arrays: dict[str, NDArray[np.float64]] = {}
        for part in note["parts"]:
            size = 2 * part["count"] * part["width"]
            arrays[part["name"]] = unpacked(rest[:size], part)
            rest = rest[size:]
        scenes[note["name"]] = _scene(note, arrays)
    return scenes


def unpacked(planes: bytes, part: Mapping[str, Any]) -> NDArray[np.float64]:
    """Return an array (T, n) of a page in its own unit: whole numbers are sums of differences of 16 bits."""
    low, high = np.frombuffer(planes, np.uint8).reshape(2, part["width"], part["count"]).astype(np.uint16)
    steps = low + (high << 8)
    # Sums wrap around at 16 bits, as differences did.
    whole = np.cumsum(steps, axis=1, dtype=np.uint16).view(np.int16)
    return np.asarray(whole.T, dtype=np.float64) * float(part["step"])


def _scene(note: Mapping[str, Any], arrays: Mapping[str, NDArray[np.float64]]) -> PushScene:
    """Return the push of a scene; methods of the residual are stored as what they subtract from it."""
    count = int(note["count"])
    names = [method for method, _ in note["methods"]]
    estimates: dict[str, NDArray[np.float64]] = {}
    for method in names:
        estimates[method] = arrays[method] if is_whole(names, method) else arrays[OBSERVER] - arrays[method]
    flags: dict[str, NDArray[np.bool_]] = {}
    for key in FLAGS:
        flags[key] = np.zeros(count, dtype=bool)
        for start, end in note["flags"][key]:
            flags[key][start:end] = True
    return PushScene(
        joints=tuple(joint for joint, _ in note["joints"]),
        rate_hz=float(note["rate"]),
        gain_hz=float(note["gain"]),
        first=0,
        settled=int(note["lead"]),
        start=int(note["start"]),
        end=int(note["end"]),
        truth=arrays["truth"],
        push=arrays["push"],
        estimates=estimates,
        stds={method: arrays[f"std {method}"] for method in note["stds"]},
        flags=flags,
        q=np.zeros((0, 0)),
        force=np.zeros((0, 3)),
    )


def main() -> int:
    """Write the published page again; return the exit status."""
    return run_renewal(lambda: explore_again(load_settings(), SNAPSHOT, TEMPLATES / PAGE), log)


if __name__ == "__main__":
    sys.exit(main())

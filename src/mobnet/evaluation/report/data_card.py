"""The data card docs/data.md, generated from the recordings' schema and the configuration.

`python -m mobnet.evaluation.report.data_card` writes it; a test fails where it is not current.
"""

from __future__ import annotations

import inspect
import json
import re
from collections.abc import Iterator, Mapping, Sequence
from itertools import groupby
from pathlib import Path
from typing import Any

from mobnet.core.config import FIRST_TRAINING_SEED, load_config, load_layout
from mobnet.core.files import write_text
from mobnet.core.joints import JointLayout
from mobnet.core.recording import Column, Sensed, Truth, recording_columns
from mobnet.estimation.observe import residual_columns
from mobnet.evaluation.tables.layout import markdown_table

CONFIG, CARD = Path("configs/config.yaml"), Path("docs/data.md")
TRAINING, MINUTE_S = "train", 60.0
SHOWN = 3  # columns of a group named before the rest is counted
HEAD = """# Data card

Generated from the recordings' schema and `configs/config.yaml` by `python -m mobnet.evaluation.report.data_card`; do
not edit. Everything is simulated: TOCABI walks and moves in MuJoCo as section 4.3 of the paper describes. Nothing was
measured on a robot, and no person's data is in it. What came out stands in the tables `data`, `steps`, `coverage` and
`uncertainty` and the figures `figure_19` and `commands`.
"""
FILES = """
## Files
One recording is two files, `NAME.parquet` (float32, one row a sample, {rate:g} rows a second) and `NAME.json` (columns
with unit and frame, number of rows, contiguous segments, terrain of each segment, falls, seed, provenance). A segment
ends with its episode or, {dropped:g} s earlier, with a fall: samples of two segments are not neighbours in time.

- `results/<scale>/recordings/<scenario>/<level>/s<seed>`: what the robot sensed, and the truth
- `results/<scale>/residuals/<scenario>/<level>/s<seed>`: what the observer makes of it, and the torque for the label
- `results/<scale>/motions/<name>/s<seed>`: knots of the upper body's joint targets

Three lines read one:

```python
import pandas as pd
name = "results/{scale}/recordings/{scenario}/{level}/s{seed}.parquet"
frame = pd.read_parquet(name, columns=["q.LL3", "v.LL3", "tau_des.LL3", "tau_ext.LL3"])  # or all columns
```
"""
SPLIT = """
## Seeds and splits
Tests have the seeds 1, 2, and so on, training recordings {first} and up. A recording's random numbers come from the
configuration's seed ({seed}), its scenario (or the one that its key `draws` names) and its own seed, with a stream each
for commands, noise, random torque, place, pushes and terrain: tests share no draw with training, and a file does not
depend on the number of cores. Of every segment the last {share:.0%} of samples, one contiguous block, validate and the
others train (9:1, section 4.3); single samples of a stream are never shuffled into both.
"""
DRAWN = {  # section of the configuration -> what its numbers rule
    "scenarios": "what is walked: terrains (one an episode), commands, random torque, pushes, motion of the upper body",
    "commands": "walking commands (Table 2), drawn as a joystick would be held",
    "terrain": "the ground; the robot is placed on it at random, facing anywhere",
    "pushes": "external forces and torques, part of the true external torque",
    "random_torque": "random torque exploration (section 4.3): each joint on its own, never on a leg that carries load",
    "motions": "motion of waist, neck and arms",
    "levels": "uncertainty levels (section 5.1)",
}


def main() -> None:
    """Write the card of the repository's configuration."""
    config = load_config(CONFIG)
    write_text(CARD, card(config, load_layout(Path(config["robot"]))))


def card(config: Mapping[str, Any], layout: JointLayout) -> str:
    """Return the card as Markdown.

    Args:
        config: resolved configuration.
        layout: joints.
    """
    walk = config["sizes"][TRAINING]["walk"]
    facts = {
        "rate": config["rates"]["data_hz"], "dropped": config["recording"]["dropped_before_fall_s"],
        "scale": config["scale"], "scenario": walk["scenario"], "level": walk["level"], "seed": FIRST_TRAINING_SEED,
    }  # fmt: skip
    split = {
        "first": FIRST_TRAINING_SEED, "seed": config["seed"], "share": config["learning"]["validation_share"],
    }  # fmt: skip
    parts = [HEAD, FILES.format(**facts), "\n## Columns\n", *columns(config, layout), sizes(config["scales"])]
    parts += [SPLIT.format(**split), "\n## What was drawn from what\n", *drawn(config)]
    return "".join(parts)


def columns(config: Mapping[str, Any], layout: JointLayout) -> Iterator[str]:
    """Yield the tables of the columns of a recording and of a residual, a row for each group of one unit and frame."""
    header = ["field", "columns", "number", "unit", "frame", "what it is"]
    groups = recording_columns(layout)
    for kind, title in ((Sensed, "sensed by the robot"), (Truth, "truth, which no estimator may see")):
        said = field_texts(kind)
        rows = [row for field in groups if field in said for row in column_rows(field, groups[field], said[field])]
        yield f"\nA recording, {title}:\n\n" + markdown_table(header, rows, left=len(header))
    gain = config["observer"]["gain_hz"]
    said = {
        "r": f"the observer's residual, eq. (9), gain {gain:g} 1/s",
        "tau_ext_lp": "external torque behind the observer's low-pass, eq. (15); r less this is the label",
    }
    grouped = groupby(residual_columns(layout), key=lambda column: column[0].split(".")[0])
    rows = [row for field, found in grouped for row in column_rows(field, list(found), said[field])]
    yield "\nA residual:\n\n" + markdown_table(header, rows, left=len(header))


def field_texts(kind: type) -> dict[str, str]:
    """Return field -> what its docstring says, one line each."""
    block = inspect.cleandoc(kind.__doc__ or "").partition("Attributes:\n")[2]
    entries = re.split(r"\n {4}(?=\w+: )", "\n" + block)
    pairs = (entry.partition(": ") for entry in entries if entry.strip())
    return {name.strip(): " ".join(text.split()) for name, _, text in pairs}


def column_rows(field: str, found: Sequence[Column], text: str) -> Iterator[list[str]]:
    """Yield the row of each run of columns with one unit and frame; the text stands at the first."""
    for (unit, frame), run in groupby(found, key=lambda column: column[1:]):
        names = [f"`{name}`" for name, _, _ in run]
        shown = names if len(names) <= SHOWN + 1 else [*names[:SHOWN], "...", names[-1]]
        yield [f"`{field}`" if text else "", ", ".join(shown), str(len(names)), unit, frame, text]
        text = ""


def sizes(scales: Mapping[str, Any]) -> str:
    """Return the table of the sets of every scale, lengths in [min]."""
    rows = []
    for scale, entry in scales.items():
        for name, part in entry[TRAINING].items():
            minutes = part["shards"] * part["shard_s"] / MINUTE_S
            rows.append([scale, name, part["scenario"], part["level"], str(part["shards"]), f"{minutes:g}"])
        minutes = entry["test"]["shards"] * entry["test"]["shard_s"] / MINUTE_S
        rows.append([scale, "test", "each test", "as its table asks", str(entry["test"]["shards"]), f"{minutes:g}"])
    header = ["scale", "set", "scenario", "level", "recordings", "minutes"]
    return "\n## Sets\n\n" + markdown_table(header, rows, left=4)


def drawn(config: Mapping[str, Any]) -> Iterator[str]:
    """Yield a table for each section of the configuration that the data are drawn from; units stand in the keys."""
    noise = "standard deviations of the sensors' white noise (Table 3)"
    sections = {section: (text, config[section]) for section, text in DRAWN.items()}
    for section, (text, values) in (sections | {"plant.noise_std": (noise, config["plant"]["noise_std"])}).items():
        rows = [[f"`{key}`", json.dumps(value)] for key, value in values.items()]
        yield f"\n### `{section}`: {text}\n\n" + markdown_table(["key", "value"], rows, left=2)


if __name__ == "__main__":
    main()

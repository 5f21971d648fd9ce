"""The data card docs/data.md, generated from the columns of recordings and the configuration.

`python -m experiments.site data` writes it; a test fails when it is out of date.
"""

import inspect
import json
import re
from collections.abc import Iterator, Sequence
from functools import reduce
from itertools import groupby
from operator import getitem
from pathlib import Path

from experiments.evaluation.tables.layout import markdown_table
from experiments.plan.seeds import FIRST_DEVELOPMENT_SEED, FIRST_TRAINING_SEED
from experiments.settings.catalogue import Catalogue
from experiments.settings.load import load_settings
from experiments.settings.scales import Scale
from experiments.settings.settings import Settings
from mobnet.core.columns import Column, recording_columns, residual_columns
from mobnet.core.files import write_text
from mobnet.core.joints import JointLayout
from mobnet.core.recording import Sensed, Truth
from mobnet.settings.data import Recordings

CARD = Path("docs/data.md")
MINUTE_S = 60.0
SHOWN = 3  # columns of a group that are named before the last one
HEAD = """# Data card

Generated from the columns of recordings and `configs` by `python -m experiments.site data`: do
not edit.
Everything is simulated: TOCABI walks and moves in MuJoCo as section 4.3 of the original describes. Nothing was measured
on a robot, and no person's data is in it. The tables `data`, `steps`, `coverage` and `uncertainty` and the figures
`figure_19` and `commands` show what the recordings hold.
"""
FILES = """
## Files
One recording is two files, `NAME.parquet` (float32, one row for each sample, {rate:g} rows a second) and `NAME.json`
(columns with unit and frame, number of rows, contiguous segments, terrain of each segment, falls, seed, provenance). A
segment ends with its episode or {dropped:g} s before a fall: samples of two segments are not consecutive in time.

- `results/<scale>/<robot>/recordings/<scenario>/<level>/s<seed>`: what the robot sensed, and the truth
- `results/<scale>/<robot>/residuals/<scenario>/<level>/s<seed>`: the observer's residual, and the torque for the label
- `results/<scale>/motions/<name>/s<seed>`: knots of the upper body's joint targets

Three lines read a recording:

```python
import pandas as pd
name = "results/{scale}/plant/recordings/{scenario}/{level}/s{seed}.parquet"
frame = pd.read_parquet(name, columns=["q.LL3", "v.LL3", "tau_des.LL3", "tau_ext.LL3"])  # or all columns
```
"""
SPLIT = """
## Seeds and splits
Seeds of tests count from {test},
those of the walks on which methods are chosen from {development}, those of training recordings from {first}: the three
share no draw. The random numbers of a recording come from the seed of the configuration ({seed}), from its scenario (or
the one that its key `draws` names) and from its own seed, with separate streams for commands, noise, random torque,
place, pushes and terrain. So a file does not depend on the number of cores. `docs/results/seeds.json` lists the test
seeds that published runs walked; a run with other methods that walks one of them again is not published. The runs of
versions 0.3.0 and 0.5.0 were published before this was checked, and walked seeds again.

The last {share:.0%} of the samples of every segment, one contiguous block, are for validation, the others for training
(9:1, section 4.3). Of the motion of the upper body, the last part validates in all its variants, because variants of
one part differ in speed and place alone.
"""
DRAWN = {  # section of the configuration -> what its numbers determine
    "scenarios": "terrains (one for each episode), commands, random torque, pushes and motion of the upper body",
    "commands": "walking commands (Table 2), held and changed as with a joystick",
    "terrain": "the ground; the robot is placed on it at a random place with a random heading",
    "pushes": "external forces and torques, part of the true external torque",
    "random_torque": "random torque exploration (section 4.3), drawn for each joint, never on a leg that carries load",
    "motions": "motion of waist, neck and arms",
    "levels": "uncertainty levels (section 5.1)",
    "plant.noise": "the sensors' white noise (Table 3), as printed; `noise` of a level says how it is read",
    "plant.own_noise": "errors of sensors that Table 3 does not have, at every level with noise",
}

# Sections whose rows are long: the card names the rows, and their numbers stand in the file with unit and source.
NAMED = {
    "scenarios": "configs/data.yaml", "pushes": "configs/data.yaml", "motions": "configs/data.yaml",
    "levels": "configs/plant.yaml",
}  # fmt: skip


def renew() -> None:
    """Write the card of the repository's configuration."""
    write_text(CARD, card(load_settings()))


def card(settings: Settings) -> str:
    """Return the card of a configuration as Markdown."""
    walk = settings.training_sets["walk"]
    files = FILES.format(
        rate=settings.rates.data_hz,
        dropped=settings.recording.dropped_before_fall_s,
        scale=settings.scale,
        scenario=walk.scenario,
        level=walk.level,
        seed=FIRST_TRAINING_SEED,
    )
    test = ", ".join(f"{row.test.first_seed} (scale {name})" for name, row in settings.scales.items())
    split = SPLIT.format(
        test=test,
        development=FIRST_DEVELOPMENT_SEED,
        first=FIRST_TRAINING_SEED,
        seed=settings.seed,
        share=settings.learning.validation_share,
    )
    tables = columns(settings.layout, settings.observer.gain_hz)
    parts = [HEAD, files, "\n## Columns\n", *tables, sizes(settings), split]
    return "".join([*parts, "\n## What was drawn from what\n", *drawn(settings)])


def columns(layout: JointLayout, gain_hz: float) -> Iterator[str]:
    """Yield the tables of the columns of a recording and of a residual, a row for each group of one unit and frame.

    `gain_hz` is the observer's gain [1/s].
    """
    header = ["field", "columns", "number", "unit", "frame", "what it is"]
    groups = recording_columns(layout)
    for kind, title in ((Sensed, "sensed by the robot"), (Truth, "truth, which no estimator may see")):
        texts = field_texts(kind)
        rows: list[list[str]] = []
        for field, group in groups.items():
            if field in texts:
                rows += column_rows(field, group, texts[field])
        yield f"\nA recording, {title}:\n\n" + markdown_table(header, rows, left=len(header))
    texts = {
        "r": f"the observer's residual, eq. (9), gain {gain_hz:g} 1/s",
        "tau_ext_lp": "external torque behind the observer's low-pass filter, eq. (15); r minus this is the target",
        "label_lp": "the same by the foot sensors, J^T F of eq. (2), which surrogate robots learn in its place",
    }
    rows = []
    for field, found in groupby(residual_columns(layout, labelled=True), key=lambda column: column[0].split(".")[0]):
        rows += column_rows(field, list(found), texts[field])
    yield "\nA residual:\n\n" + markdown_table(header, rows, left=len(header))


def field_texts(kind: type) -> dict[str, str]:
    """Return field -> what its docstring says, one line each."""
    block = inspect.cleandoc(kind.__doc__ or "").partition("Attributes:\n")[2]
    entries = re.split(r"\n {4}(?=\w+: )", "\n" + block)
    pairs = (entry.partition(": ") for entry in entries if entry.strip())
    return {name.strip(): " ".join(text.split()) for name, _, text in pairs}


def column_rows(field: str, found: Sequence[Column], text: str) -> Iterator[list[str]]:
    """Yield the row of each run of columns with one unit and frame; only the first has the text."""
    for (unit, frame), run in groupby(found, key=lambda column: column[1:]):
        names = [f"`{name}`" for name, _, _ in run]
        shown = names if len(names) <= SHOWN + 1 else [*names[:SHOWN], "...", names[-1]]
        yield [f"`{field}`" if text else "", ", ".join(shown), str(len(names)), unit, frame, text]
        text = ""


def sizes(settings: Settings) -> str:
    """Return the table of all sets: of each scale recordings x length of one [min]."""
    cells: dict[tuple[str, str, str], dict[str, str]] = {}
    for scale, entry in settings.scales.items():
        sets: list[tuple[tuple[str, str, str], Recordings]] = []
        for name, row in settings.training_sets.items():
            sets.append(((name, row.scenario, row.level), row.sizes[scale]))
        sets += tests(settings, entry)
        for names, part in sets:
            cells.setdefault(names, {})[scale] = f"{part.shards} x {part.shard_s / MINUTE_S:.3g}"
    rows: list[list[str]] = []
    for names, sized in cells.items():
        rows.append([*names, *(sized.get(scale, "-") for scale in settings.scales)])
    header = ["set", "scenario", "level", *settings.scales]
    return "\n## Sets\n\nRecordings x minutes of each, by scale.\n\n" + markdown_table(header, rows, left=3)


def tests(settings: Settings, entry: Scale) -> Iterator[tuple[tuple[str, str, str], Recordings]]:
    """Yield set, scenario and level of the tests of a scale, each with its size; a robot's may be fewer recordings."""
    asked = "as its table asks"
    own = entry.test.model_copy(update={"shards": entry.fleet_shards or entry.test.shards})
    yield ("test", "each test", asked), entry.test
    yield ("test", "each test of a robot", asked), own
    plants = settings.levels.keys() - set(settings.fleet.robots)
    walked = Catalogue(settings).tests
    for name, duration in entry.durations_s.items():
        row = entry.test if plants.intersection(walked.get(name, ())) else own
        yield ("test", name, asked), row.model_copy(update={"shard_s": duration})


def drawn(settings: Settings) -> Iterator[str]:
    """Yield what each section of the configuration that the data are drawn from holds; units are in the keys."""
    written = settings.model_dump(mode="json", exclude_unset=True)
    for section, text in DRAWN.items():
        values = reduce(getitem, section.split("."), written)
        title = f"\n### `{section}`: {text}\n\n"
        if section in NAMED:
            names = ", ".join(f"`{key}`" for key in values)
            yield f"{title}`{NAMED[section]}` holds them: {names}.\n"
        else:
            rows = [[f"`{key}`", json.dumps(value)] for key, value in values.items()]
            yield title + markdown_table(["key", "value"], rows, left=2)

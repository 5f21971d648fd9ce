"""The examples of CONTRIBUTING.md, applied to a copy of the project, do what they say and touch few files."""

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import pytest
import yaml

from .test_newcomer import NAME, example

ROOT = Path(__file__).parents[3]
DATA, EVALUATION = "configs/data.yaml", "configs/evaluation.yaml"
BLOCK = re.compile(
    r"^ *`(?P<file>[^`]+)`, (?:(?P<where>above|below) `(?P<line>[^`]+)`|a new file)\n\n"
    r"(?P<indent> *)```\w+\n(?P<text>.*?)^(?P=indent)```$",
    re.DOTALL | re.MULTILINE,
)
SCRIPT = """
import importlib.util, json, sys
from dataclasses import replace
from pathlib import Path

import numpy as np

from experiments.settings.metrics import metric_of
from experiments.evaluation.compare.pair import Pair
from experiments.evaluation.compare.scene import Scene
from experiments.evaluation.measure.estimates import run_errors
from experiments.evaluation.measure.estimates.scores import measured
from experiments.evaluation.measure.estimates.scores import measure_problems
from experiments.plan.plan import make_plan
from experiments.plan.sheets import Sheets
from types import SimpleNamespace
from experiments.settings.load import load_settings

golden, example, names = Path(sys.argv[1]), sys.argv[2], sys.argv[3:]
settings = load_settings(Path("configs"), {"scale": "smoke"})
plan = make_plan(settings, with_pdf=False)
products = {product.name: product for product in plan.products}
for call in (products[name].call for name in names):
    for folder in (plan.folders.tables, plan.folders.figures, Path("tested")):
        folder.mkdir(parents=True, exist_ok=True)
    replace(call, arguments={**call.arguments, "scores": [golden / "scores.csv"]}).run()
spec = importlib.util.spec_from_file_location("example", example)
module = importlib.util.module_from_spec(spec)
module.__file__ = str(golden.parent / example.removeprefix("tests/"))
spec.loader.exec_module(module)
for name in [name for name in vars(module) if name.startswith("test_")]:
    getattr(module, name)(settings, Path("tested"))
def wildcards(scenario, robot="plant", level="all_uncertainty"):
    return SimpleNamespace(robot=robot, scenario=scenario, level=level)


score = plan.jobs.score(wildcards("forward_walk"))
run = next(run for run in score["runs"] if run.method == "MOB")
pair = Pair(run, ("LL1", "LL2"), np.full((200, 2), [3.0, 4.0]), np.ones((200, 2)), ((0, 200),), 100.0)
asked = score["asked"]
asked = asked.model_copy(update={"sections": {"bias": asked.sections["bias"]}})
scene = Scene(run.recording, settings.layout, asked)
estimated = {}
for own in plan.files.owners:
    for scenario, levels in own.catalogue.tests.items():
        for level in filter(own.has, levels):
            runs = plan.jobs.estimate(wildcards(scenario, own.robot or "plant", level))["runs"]
            estimated.setdefault(scenario, []).extend(run.method for run in runs)
run_errors.measure = lambda *_: iter(())
_, (_, measures) = measured(pair, scene)
WRONG = {"evaluation": {"measures": {"bias": {"options": {"after_s": -1.0}}}}}
print(json.dumps({
    "bias": [(metric, values.tolist(), metric_of(metric).units) for metric, values, _ in measures],
    "modules": plan.jobs.measured_by(wildcards("forward_walk")),
    "methods_of_table_07": products["table_07"].call.arguments["settings"].rows[0].further,
    "refused": list(measure_problems(load_settings(Path("configs"), {"scale": "smoke", **WRONG}))),
    "estimated": estimated,
    "recorded_s": plan.jobs.collect(wildcards("plates_walk"))["duration_s"],
    "recorded": list(plan.jobs.collect(wildcards("plates_walk"))["seeds"]),
    "observed": Sheets(plan).sets["plant/plates_walk/all_uncertainty"]["seeds"],
    "products": {product.name: [product.inputs, product.outputs] for product in plan.products},
}))
"""


class Block(NamedTuple):
    """Text for a file: the whole of a new one, or lines above or below a line of it."""

    file: str
    where: str | None
    line: str | None
    text: str


def blocks(title):
    """Return the blocks of a page of the guide."""
    page = (ROOT / "CONTRIBUTING.md").read_text().split(f"\n## {title}\n")[1].split("\n## ")[0]
    found = list(BLOCK.finditer(page))
    assert len(found) == page.count("```") / 2, "a block without the name of its file"
    texts = [re.sub(rf"^{match['indent']}", "", match["text"], flags=re.MULTILINE) for match in found]
    return [Block(m["file"], m["where"], m["line"], text) for m, text in zip(found, texts, strict=True)]


SCENARIO = blocks("Add a scenario and a training set")
ERRORS = blocks("Add a table of errors")
MEASURE = blocks("Add a measure")
FIGURE = blocks("Add a figure")


def apply(block, folder):
    """Write a block into its file below a folder."""
    path = folder / block.file
    if block.where is None:
        assert not path.exists()
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(block.text)
        return
    lines = path.read_text().splitlines(keepends=True)
    (place,) = [number for number, line in enumerate(lines) if line.strip() == block.line]
    lines.insert(place + (block.where == "below"), block.text)
    path.write_text("".join(lines))


@pytest.fixture(scope="module")
def copy(tmp_path_factory):
    """A copy of the project with every example in it."""
    folder = tmp_path_factory.mktemp("project")
    for part in ("src", "configs", "workflow/report"):
        shutil.copytree(ROOT / part, folder / part, ignore=shutil.ignore_patterns("__pycache__"))
    for name in ("environment.lock", "pyproject.toml"):
        shutil.copy2(ROOT / name, folder / name)
    for block in (*SCENARIO, *ERRORS, *MEASURE, *FIGURE):
        apply(block, folder)
    show_in_table_07(folder)
    return folder


def show_in_table_07(folder):
    """Add the method of the guide: its file, its row, and one word in a row of Table 7."""
    (folder / "src/mobnet/estimation/kinds/dead_band.py").write_text(example("python"))
    row = "".join(f"  {line}\n" for line in example("yaml").splitlines())
    apply(Block("configs/methods.yaml", "below", "methods:", row), folder)
    path = folder / EVALUATION
    before, after = path.read_text().split("    table_07:\n")
    path.write_text(before + "    table_07:\n" + after.replace("further: [", f"further: [{NAME}, ", 1))


@pytest.fixture(scope="module")
def told(copy):
    """What the plan of the copy has, after its new table and figure were made from the frozen scores."""
    example = next(block.file for block in FIGURE if block.file.startswith("tests/"))
    words = [sys.executable, "-c", SCRIPT, str(ROOT / "tests/golden"), example, "roughness", "joint_errors"]
    environment = {**os.environ, "PYTHONPATH": str(copy / "src")}
    done = subprocess.run(words, cwd=copy, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def test_each_task_of_the_guide_touches_few_files():
    assert [block.file for block in SCENARIO] == [DATA, DATA]
    assert [[*yaml.safe_load(b.text)] for b in (*SCENARIO, *ERRORS)] == [["plates_walk"], ["plates"], ["roughness"]]
    assert [block.file for block in (*ERRORS, MEASURE[2])] == [EVALUATION] * 2
    assert MEASURE[1].file == "src/experiments/settings/metrics.py"
    assert Path(MEASURE[0].file).parent == Path("src/experiments/evaluation/measure/estimates")
    # An entry, a row, a module and a caption.
    assert len({block.file for block in FIGURE if not block.file.startswith("tests/")}) == 4


def test_one_word_shows_a_new_method_in_table_07_and_runs_it(told):
    assert [scenario for scenario, methods in told["estimated"].items() if NAME in methods] == ["walk_test"]
    assert NAME in told["methods_of_table_07"]


def test_the_measure_is_taken_where_its_entry_says(told):
    assert told["bias"] == [["bias", [2.0, 3.0], ["N", "N m"]]]
    assert told["modules"][-1] == "experiments.evaluation.measure.estimates.bias"
    ((place, text),) = told["refused"]
    assert place == ["evaluation", "measures", "bias", "options", "after_s"]
    assert text == "-1.0 is not accepted; accepted: a number from 0"


def test_the_training_set_is_recorded(told):
    assert told["recorded"] == [1000]
    assert told["observed"] == [1000]
    assert told["recorded_s"] == 20.0


@pytest.mark.parametrize(("name", "files"), [
    ("roughness", [f"tables/smoke/roughness.{ending}" for ending in ("csv", "tex", "md")]),
    ("joint_errors", [f"figures/smoke/joint_errors.{ending}" for ending in ("pdf", "svg", "png", "csv")]),
])  # fmt: skip
def test_the_new_product_reads_the_scores_and_writes_its_files(name, files, told, copy):
    inputs, outputs = told["products"][name]
    assert inputs == ["results/smoke/scores/forward_walk/all_uncertainty.csv"]
    assert outputs == files
    assert all((copy / file).stat().st_size > 0 for file in files)
    assert set(told["products"]["paper"][0]) >= {file for file in files if file.endswith((".tex", ".pdf"))}


def test_what_is_copied_from_the_guide_is_in_the_house_style(copy):
    files = [block.file for block in (*MEASURE, *FIGURE) if block.file.endswith(".py")]
    files.append("src/mobnet/estimation/kinds/dead_band.py")
    for check in (["check", "--no-cache"], ["format", "--check"]):
        command = [sys.executable, "-m", "ruff", *check, *files]
        done = subprocess.run(command, cwd=copy, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stdout + done.stderr

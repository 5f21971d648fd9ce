"""The examples of CONTRIBUTING.md, applied to a copy of the project, do what they say and touch few files."""

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any, NamedTuple

import pytest
import yaml

ROOT = Path(__file__).parents[2]
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
from mobnet.plan.plan import make_plan
from mobnet.settings.load import load_settings

golden, example, names = Path(sys.argv[1]), sys.argv[2], sys.argv[3:]
settings = load_settings(Path("configs"), {"scale": "smoke"})
plan = make_plan(settings, with_pdf=False)
products = {product.name: product for product in plan.products}
for call in (products[name].job.call for name in names):
    for folder in (plan.folders.tables, plan.folders.figures, Path("tested")):
        folder.mkdir(parents=True, exist_ok=True)
    replace(call, arguments={**call.arguments, "scores": [golden / "scores.csv"]}).run()
spec = importlib.util.spec_from_file_location("example", example)
module = importlib.util.module_from_spec(spec)
module.__file__ = str(golden.parent / example.removeprefix("tests/"))
spec.loader.exec_module(module)
for name in [name for name in vars(module) if name.startswith("test_")]:
    getattr(module, name)(settings, Path("tested"))
print(json.dumps({
    "stored": plan.stored,
    "recorded": next(
        step.job.call.arguments["duration_s"] for step in plan.steps if "/plates_walk/" in step.outputs[0]
    ),
    "products": {product.name: [product.job.inputs, product.outputs] for product in plan.products},
}))
"""


class Block(NamedTuple):
    """Text for a file: the whole of a new one, or lines above or below a line of it."""

    file: str
    where: str | None
    line: str | None
    text: str


def blocks(title: str) -> list[Block]:
    """Return the blocks of a page of the guide."""
    page = (ROOT / "CONTRIBUTING.md").read_text().split(f"\n## {title}\n")[1].split("\n## ")[0]
    found = list(BLOCK.finditer(page))
    assert len(found) == page.count("```") / 2, "a block without the name of its file"
    texts = [re.sub(rf"^{match['indent']}", "", match["text"], flags=re.MULTILINE) for match in found]
    return [Block(m["file"], m["where"], m["line"], text) for m, text in zip(found, texts, strict=True)]


SCENARIO = blocks("Add a scenario and a training set")
ERRORS = blocks("Add a table of errors")
FIGURE = blocks("Add any other table or figure")


def apply(block: Block, folder: Path) -> None:
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
def copy(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the project with every example in it."""
    folder = tmp_path_factory.mktemp("project")
    for part in ("src", "configs", "workflow/report"):
        shutil.copytree(ROOT / part, folder / part, ignore=shutil.ignore_patterns("__pycache__"))
    for name in ("environment.lock", "pyproject.toml"):
        shutil.copy2(ROOT / name, folder / name)
    for block in (*SCENARIO, *ERRORS, *FIGURE):
        apply(block, folder)
    return folder


@pytest.fixture(scope="module")
def told(copy: Path) -> dict[str, Any]:
    """What the plan of the copy has, after its new table and figure were made from the frozen scores."""
    example = next(block.file for block in FIGURE if block.file.startswith("tests/"))
    words = [sys.executable, "-c", SCRIPT, str(ROOT / "tests/golden"), example, "roughness", "joint_errors"]
    environment = {**os.environ, "PYTHONPATH": str(copy / "src")}
    done = subprocess.run(words, cwd=copy, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def test_a_scenario_and_a_training_set_are_a_row_each() -> None:
    assert [block.file for block in SCENARIO] == [DATA, DATA]
    assert [list(yaml.safe_load(block.text)) for block in SCENARIO] == [["plates_walk"], ["plates"]]


def test_a_table_of_errors_is_an_entry() -> None:
    (block,) = ERRORS
    assert block.file == EVALUATION
    assert list(yaml.safe_load(block.text)) == ["roughness"]


def test_another_figure_is_five_files_or_fewer() -> None:
    assert len({block.file for block in FIGURE}) <= 5


def test_the_training_set_is_recorded(told: dict[str, Any]) -> None:
    for kind in ("recordings", "residuals"):
        assert f"results/smoke/{kind}/plates_walk/all_uncertainty/s1000.parquet" in told["stored"]
    assert told["recorded"] == 20.0


@pytest.mark.parametrize(
    ("name", "files"),
    [
        ("roughness", [f"tables/smoke/roughness.{ending}" for ending in ("csv", "tex", "md")]),
        ("joint_errors", [f"figures/smoke/joint_errors.{ending}" for ending in ("pdf", "png", "csv")]),
    ],
)
def test_the_new_product_reads_the_scores_and_writes_its_files(
    name: str, files: list[str], told: dict[str, Any], copy: Path
) -> None:
    inputs, outputs = told["products"][name]
    assert inputs == ["results/smoke/scores/forward_walk/all_uncertainty.csv"]
    assert outputs == files
    assert all((copy / file).stat().st_size > 0 for file in files)
    assert set(told["products"]["paper"][0]) >= {file for file in files if file.endswith((".tex", ".pdf"))}


def test_what_is_copied_from_the_guide_is_in_the_house_style(copy: Path) -> None:
    files = [block.file for block in FIGURE if block.file.endswith(".py")]
    for check in (["check", "--no-cache"], ["format", "--check"]):
        command = [sys.executable, "-m", "ruff", *check, *files]
        done = subprocess.run(command, cwd=copy, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stdout + done.stderr

"""Table 1: inputs, targets and sizes of the limb networks, counted from the networks themselves."""

from __future__ import annotations

import logging
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mobnet.core.config import load_layout, read_yaml
from mobnet.core.files import write_text
from mobnet.core.joints import JointLayout
from mobnet.core.methods import network_row
from mobnet.evaluation.number.rows import write_rows
from mobnet.evaluation.tables.layout import markdown_table, tex_escape, tex_table
from mobnet.learning.dataset import joints_of
from mobnet.learning.features import limb_inputs
from mobnet.learning.model import build_network, parameter_count

log = logging.getLogger(__name__)

HEADER = ["Network", "Input", "Numbers", "Target", "Architecture", "Parameters", "Paper", "Horizon", "Paper", "Data"]
COLUMNS = "llrllrrrrl"
LEFT = 5  # columns of text
TARGETS = {"uncertainty": "r^{limb} - tau_ext^{limb}", "external": "tau_ext^{limb}"}  # eq. (15), both low-passed alike
TEX_TAU = r"\tilde\tau_{\mathrm{ext}}"


@dataclass(frozen=True)
class Architecture:
    """One limb network: a row of table_01.csv.

    Attributes:
        limb: row of the configuration's networks.
        inputs: symbols of eq. (17): Q positions and velocities, T desired torques of a limb, U^V the pelvis.
        input_count: how many numbers these are.
        target: what is learned, in symbols.
        architecture: [inputs, state] and [state, outputs] of the layers.
        parameters: trained parameters.
        horizon_steps: of truncated back-propagation [samples].
        data: training set.
        architecture_published: the paper's, in the same words.
        parameters_published: the paper's.
        horizon_published: the paper's [samples].
    """

    limb: str
    inputs: str
    input_count: int
    target: str
    architecture: str
    parameters: int
    horizon_steps: int
    data: str
    architecture_published: str
    parameters_published: int
    horizon_published: int


def table_01(config: Mapping[str, Any], out_dir: Path) -> None:
    """Write Table 1 as CSV, TeX and Markdown, each network built and its parameters counted.

    Args:
        config: resolved configuration: `robot`, `published`, `networks`, `methods`, `learning` and
            `evaluation.table_01`, the method whose networks are shown; the paper's rows name the limbs.
        out_dir: gets table_01.csv, .tex and .md.

    Raises:
        ConfigError: the method or a limb is unknown.
    """
    layout = load_layout(Path(config["robot"]))
    printed = read_yaml(Path(config["published"]))["table_01"]["rows"]
    rows = [describe(config, layout, limb, entry) for limb, entry in printed.items()]
    lines = [cells(row) for row in rows]
    write_rows(out_dir / "table_01.csv", Architecture, rows)
    write_text(out_dir / "table_01.md", markdown_table(HEADER, lines, left=LEFT))
    write_text(out_dir / "table_01.tex", tex_table(COLUMNS, HEADER, list(map(tex_cells, lines))))
    log.info("%s: %d networks", out_dir / "table_01.csv", len(rows))


def describe(config: Mapping[str, Any], layout: JointLayout, limb: str, printed: Mapping[str, Any]) -> Architecture:
    """Build the network of a limb and describe it, beside what the paper prints of it.

    Raises:
        ConfigError: the method or the limb is unknown.
    """
    method = config["evaluation"]["table_01"]["method"]
    row = network_row(config, method, limb)
    count = len(limb_inputs(layout, row).names)
    network = build_network(row, count, len(joints_of(layout, row)), config["learning"]["std_min"], config["seed"])
    head = network.head
    return Architecture(
        limb=limb,
        inputs=", ".join([*(f"{letter}^{group}" for letter in "QT" for group in row[letter]), "U^V"]),
        input_count=count,
        target=TARGETS[config["methods"][method]["target"]].format(limb=limb),
        architecture=f"{row['cell']}[{count}, {head.in_features}]-Linear[{head.in_features}, {head.out_features}]",
        parameters=parameter_count(network),
        horizon_steps=row["horizon_steps"],
        data=row["data"],
        architecture_published=printed["architecture"],
        parameters_published=printed["parameters"],
        horizon_published=printed["horizon_steps"],
    )


def cells(row: Architecture) -> list[str]:
    """Return a network's row of text, horizons in steps [samples]."""
    numbers = (row.parameters, row.parameters_published, row.horizon_steps, row.horizon_published)
    return [row.limb, row.inputs, str(row.input_count), row.target, row.architecture, *map(str, numbers), row.data]


def tex_cells(line: Sequence[str]) -> list[str]:
    """Return a row of text as TeX, its input and target as symbols."""
    return [tex_symbols(text) if HEADER[k] in ("Input", "Target") else tex_escape(text) for k, text in enumerate(line)]


def tex_symbols(text: str) -> str:
    """Return symbols, such as `r^LL - tau_ext^LL`, as TeX."""
    raised = re.sub(r"\^(\w+)", r"^{\1}", text)
    return f"${raised.replace('tau_ext', TEX_TAU)}$"

"""Table 1: inputs, targets and sizes of the limb networks, counted from the networks themselves."""

# pandas has no complete types, which the strict rules of this folder ask for.
# pyright: standard

import re
from collections.abc import Mapping, Sequence
from pathlib import Path

import pandas as pd

from experiments.evaluation.number.frames import records_of
from experiments.evaluation.number.rows import Field
from experiments.evaluation.tables.layout import Table, tex_escape, tex_table, write_table
from experiments.settings.published import PublishedNetwork, PublishedNetworks
from experiments.settings.table_columns import TABLE_01
from mobnet.core.joints import JointLayout
from mobnet.learning.features import limb_inputs
from mobnet.learning.model import build_network, parameter_count
from mobnet.settings.methods import Target
from mobnet.settings.networks import Learning, Network

SHOWN = {  # column that a reader sees -> its head
    "limb": "Network",
    "inputs": "Input",
    "input_count": "Numbers",
    "target": "Target",
    "architecture": "Architecture",
    "parameters": "Parameters",
    "parameters_published": "Original",
    "horizon_steps": "Horizon",
    "horizon_published": "Original",
    "data": "Data",
}
SYMBOLS = ("inputs", "target")  # of these columns, set as symbols
COLUMNS = "llrllrrrrl"
LEFT = 5  # columns of text
TARGETS = {"uncertainty": "r^{limb} - tau_ext^{limb}", "external": "tau_ext^{limb}"}  # eq. (15), both low-passed alike
TEX_TAU = r"\tilde\tau_{\mathrm{ext}}"


def table_01(
    networks: Mapping[str, Network],
    target: Target,
    layout: JointLayout,
    learning: Learning,
    seed: int,
    published: PublishedNetworks,
    table_dir: Path,
) -> None:
    """Write Table 1 as CSV, TeX and Markdown, each limb's network built and its parameters counted."""
    described: list[dict[str, Field]] = []
    for limb, printed in published.rows.items():
        text = TARGETS[target].format(limb=limb)
        described.append(describe(limb, networks[limb], text, layout, learning.std_min, seed, printed))
    rows = pd.DataFrame(described)
    lines = rows[list(SHOWN)].astype(str).to_numpy().tolist()
    table = Table(TABLE_01, records_of(rows, TABLE_01), list(SHOWN.values()), lines, LEFT)
    write_table(table_dir / "table_01", table, tex_table(COLUMNS, table.header, list(map(tex_cells, lines))))


def describe(
    limb: str, network: Network, target: str, layout: JointLayout, std_min: float, seed: int, printed: PublishedNetwork
) -> dict[str, Field]:
    """Build the network of a limb and return its row of `TABLE_01`, beside what the paper prints of it.

    Inputs are the symbols of eq. (17): Q positions and velocities, T desired torques of a limb, U^V the pelvis. An
    architecture is [inputs, state] and [state, outputs] of the layers. A horizon, of truncated back-propagation, is in
    time steps.
    """
    count = len(limb_inputs(layout, network).names)
    built = build_network(network, count, len(layout.limbs(network.joints)), std_min, seed)
    head = built.head
    symbols = [f"Q^{group}" for group in network.Q] + [f"T^{group}" for group in network.T]
    inputs = ", ".join([*symbols, "U^V"])
    layers = f"{network.cell}[{count}, {head.in_features}]-Linear[{head.in_features}, {head.out_features}]"
    return {
        "limb": limb,
        "inputs": inputs,
        "input_count": count,
        "target": target,
        "architecture": layers,
        "parameters": parameter_count(built),
        "horizon_steps": network.horizon_steps,
        "data": network.data,
        "architecture_published": printed.architecture,
        "parameters_published": printed.parameters,
        "horizon_published": printed.horizon_steps,
    }


def tex_cells(line: Sequence[str]) -> list[str]:
    """Return a row of text as TeX, its input and target as symbols."""
    cells: list[str] = []
    for name, text in zip(SHOWN, line, strict=True):
        cells.append(tex_symbols(text) if name in SYMBOLS else tex_escape(text))
    return cells


def tex_symbols(text: str) -> str:
    """Return symbols, such as `r^LL - tau_ext^LL`, as TeX."""
    raised = re.sub(r"\^(\w+)", r"^{\1}", text)
    return f"${raised.replace('tau_ext', TEX_TAU)}$"

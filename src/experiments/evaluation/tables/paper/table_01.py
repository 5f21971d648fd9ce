"""Table 1: inputs, targets and sizes of the limb networks, counted from the networks themselves."""

import re
from collections.abc import Mapping, Sequence
from pathlib import Path

from experiments.evaluation.number.rows import Field
from experiments.evaluation.tables.layout import Table, tex_escape, tex_table, write_table
from experiments.settings.published import PublishedNetwork, PublishedNetworks
from experiments.settings.table_columns import TABLE_01
from mobnet.core.joints import JointLayout
from mobnet.learning.features import limb_inputs
from mobnet.learning.model import build_network, parameter_count
from mobnet.settings.methods import Target
from mobnet.settings.networks import Learning, Network

HEADER = [
    *("Network", "Input", "Numbers", "Target", "Architecture"),
    *("Parameters", "Original", "Horizon", "Original", "Data"),
]
SHOWN = (
    "limb",
    "inputs",
    "input_count",
    "target",
    "architecture",
    "parameters",
    "parameters_published",
    "horizon_steps",
    "horizon_published",
    "data",
)
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
    records = [
        describe(limb, networks[limb], TARGETS[target].format(limb=limb), layout, learning.std_min, seed, printed)
        for limb, printed in published.rows.items()
    ]
    places = [TABLE_01.index(name) for name in SHOWN]
    lines = []
    for record in records:
        lines.append([str(record[place]) for place in places])
    tex = tex_table(COLUMNS, HEADER, list(map(tex_cells, lines)))
    write_table(table_dir / "table_01", Table(TABLE_01, records, HEADER, lines, LEFT), tex)


def describe(
    limb: str, network: Network, target: str, layout: JointLayout, std_min: float, seed: int, printed: PublishedNetwork
) -> tuple[Field, ...]:
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
    sizes = parameter_count(built), network.horizon_steps
    paper = printed.architecture, printed.parameters, printed.horizon_steps
    return (limb, inputs, count, target, layers, *sizes, network.data, *paper)


def tex_cells(line: Sequence[str]) -> list[str]:
    """Return a row of text as TeX, its input and target as symbols."""
    return [tex_symbols(text) if HEADER[k] in ("Input", "Target") else tex_escape(text) for k, text in enumerate(line)]


def tex_symbols(text: str) -> str:
    """Return symbols, such as `r^LL - tau_ext^LL`, as TeX."""
    raised = re.sub(r"\^(\w+)", r"^{\1}", text)
    return f"${raised.replace('tau_ext', TEX_TAU)}$"

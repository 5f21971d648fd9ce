"""Rule `figure_10`: Figure 10 of the paper, collisions of a knee in the air and on the ground."""

from pathlib import Path

from mobnet.core.logs import job
from mobnet.evaluation.figures.figure_10 import figure_10

with job(snakemake.log[0]):
    figure_10(
        snakemake.params.config,
        snakemake.params.entries,
        {Path(name).stem: Path(name) for name in snakemake.input.scores},
        Path(snakemake.output[0]).parent,
    )

"""Rule `figure_06`: Figure 6 of the paper, a step of torque on a swinging hip."""

from pathlib import Path

from mobnet.core.logs import job
from mobnet.evaluation.figures.figure_06 import figure_06

with job(snakemake.log[0]):
    figure_06(
        snakemake.params.config,
        snakemake.params.entries,
        Path(snakemake.input.scores),
        Path(snakemake.output[0]).parent,
    )

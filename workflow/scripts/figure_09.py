"""Rule `figure_09`: Figure 9 of the paper, external torque of the left leg by method."""

from pathlib import Path

from mobnet.core.logs import job
from mobnet.evaluation.figures.figure_09 import figure_09

with job(snakemake.log[0]):
    figure_09(snakemake.params.config, snakemake.params.entries, Path(snakemake.output[0]).parent)

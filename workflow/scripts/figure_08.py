"""Rule `figure_08`: Figure 8 of the paper, uncertainty torque of the left leg."""

from pathlib import Path

from mobnet.core.logs import job
from mobnet.evaluation.figures.figure_08 import figure_08

with job(snakemake.log[0]):
    figure_08(snakemake.params.config, snakemake.params.entries, Path(snakemake.output[0]).parent)

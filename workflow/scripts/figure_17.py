"""Rule `figure_17`: Figure 17 of the paper, losses by kind of network."""

from pathlib import Path

from mobnet.core.logs import job
from mobnet.evaluation.figures.figure_17 import figure_17

with job(snakemake.log[0]):
    figure_17(snakemake.params.folders, Path(snakemake.output[0]).parent)

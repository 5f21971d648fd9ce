"""Rule `figure_20`: Figure 20 of the paper, size of the network and of the training data."""

from pathlib import Path

from mobnet.core.logs import job
from mobnet.evaluation.figures.figure_20 import figure_20

with job(snakemake.log[0]):
    figure_20(snakemake.params.entries, Path(snakemake.output[0]).parent)

"""Rule `figure_07`: Figure 7 of the paper, a load on the left hand."""

from pathlib import Path

from mobnet.core.logs import job
from mobnet.evaluation.figures.figure_07 import figure_07

with job(snakemake.log[0]):
    figure_07(snakemake.params.config, snakemake.params.entries, Path(snakemake.output[0]).parent)

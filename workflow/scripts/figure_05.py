"""Rule `figure_05`: Figure 5 of the paper."""

from pathlib import Path

from mobnet.core.logs import job
from mobnet.evaluation.figures.figure_05 import figure_05

with job(snakemake.log[0]):
    figure_05(snakemake.params.config, snakemake.params.entries, Path(snakemake.output[0]).parent)

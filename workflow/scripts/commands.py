"""Rule `commands`: histograms of the walking commands."""

from pathlib import Path

from mobnet.core.logs import job
from mobnet.evaluation.figures.commands import commands

with job(snakemake.log[0]):
    commands(snakemake.params.config, snakemake.params.sets, Path(snakemake.output[0]).parent)

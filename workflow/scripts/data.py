"""Rule `data`: what the training sets hold."""

from pathlib import Path

from mobnet.core.logs import job
from mobnet.evaluation.tables.data import data

with job(snakemake.log[0]):
    data(snakemake.params.config, snakemake.params.sets, Path(snakemake.output[0]).parent)

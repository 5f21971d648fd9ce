"""Rule `error_budget`: what the observer's error is made of."""

from pathlib import Path

from mobnet.core.logs import job
from mobnet.evaluation.tables.error_budget import error_budget

with job(snakemake.log[0]):
    error_budget(snakemake.params.config, Path(snakemake.input.scores), Path(snakemake.output[0]).parent)

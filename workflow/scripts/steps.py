"""Rule `steps`: measured against commanded steps."""

from pathlib import Path

from mobnet.core.logs import job
from mobnet.evaluation.tables.steps import steps

with job(snakemake.log[0]):
    steps(snakemake.params.config, snakemake.params.sets, Path(snakemake.output[0]).parent)

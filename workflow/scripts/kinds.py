"""Rule `kinds`: kinds of networks in numbers."""

from pathlib import Path

from mobnet.core.logs import job
from mobnet.evaluation.tables.kinds import kinds

with job(snakemake.log[0]):
    kinds(snakemake.params.config, snakemake.params.folders, Path(snakemake.output[0]).parent)

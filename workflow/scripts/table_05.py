"""Rule `table_05`: Table 5 of the paper."""

from pathlib import Path

from mobnet.core.logs import job
from mobnet.evaluation.tables import table_05

with job(snakemake.log[0]):
    table_05(snakemake.params.config, Path(snakemake.input.scores), Path(snakemake.output[0]).parent)

"""Rule `table_01`: Table 1 of the paper, from the networks themselves."""

from pathlib import Path

from mobnet.core.logs import job
from mobnet.evaluation.tables.table_01 import table_01

with job(snakemake.log[0]):
    table_01(snakemake.params.config, Path(snakemake.output[0]).parent)

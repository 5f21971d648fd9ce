"""Rule `table`: a table of errors beside the paper's."""

from pathlib import Path

from mobnet.core.logs import job
from mobnet.evaluation.tables.errors import table

with job(snakemake.log[0]):
    scores = {Path(name).stem: Path(name) for name in snakemake.input.scores}
    table(snakemake.params.config, snakemake.wildcards.table, scores, Path(snakemake.output[0]).parent)

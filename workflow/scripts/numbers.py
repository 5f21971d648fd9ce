"""Rule `numbers`: every number of the paper's prose as a TeX name."""

from pathlib import Path

from mobnet.core.logs import job
from mobnet.evaluation.report.numbers import numbers

with job(snakemake.log[0]):
    tables, judged = map(Path, snakemake.input.tables), Path(snakemake.input.claims)
    numbers(snakemake.params.config, tables, judged, Path(snakemake.output[0]))

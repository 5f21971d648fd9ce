"""Rule `paper`: the PDF where TeX is installed; elsewhere a note of what is missing."""

from pathlib import Path

from mobnet.core.logs import job
from mobnet.evaluation.report.paper import build

with job(snakemake.log[0]):
    build(
        snakemake.params.config,
        Path(snakemake.input.main),
        Path(snakemake.input.tables[0]).parent,
        Path(snakemake.input.figures[0]).parent,
        Path(snakemake.input.compute).parent,
        Path(snakemake.output[0]).with_name("main.pdf"),
    )

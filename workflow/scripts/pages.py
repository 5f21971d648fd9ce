"""Rule `pages`: a page of each table below its caption."""

from pathlib import Path

from mobnet.core.logs import job
from mobnet.evaluation.report.pages import pages

with job(snakemake.log[0]):
    captions = Path(snakemake.input.captions[0]).parent
    pages([Path(name) for name in snakemake.input.tables], captions, Path(snakemake.output[0]).parent)

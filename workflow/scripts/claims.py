"""Rule `claims`: what the paper claims and what holds here."""

from pathlib import Path

from mobnet.core.logs import job
from mobnet.evaluation.tables.claims import claims

with job(snakemake.log[0]):
    config, scores = snakemake.params.config, [Path(name) for name in snakemake.input.scores]
    claims(config, Path(config["claims"]), scores, snakemake.params.folders, Path(snakemake.output[0]).parent)

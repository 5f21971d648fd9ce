"""Rule `claims`: what the paper claims and what holds here."""

from pathlib import Path

from mobnet.core.logs import job
from mobnet.evaluation.claims import claims

with job(snakemake.log[0]):
    config = snakemake.params.config
    claims(config, Path(config["claims"]), Path(snakemake.input.scores), Path(snakemake.output[0]).parent)

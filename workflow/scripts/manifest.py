"""Rule `manifest`: the hash of every result file."""

from pathlib import Path

from mobnet.core.logs import job
from mobnet.evaluation.report.manifest import write_manifest

with job(snakemake.log[0]):
    write_manifest([Path(name) for name in snakemake.input], Path(snakemake.output[0]))

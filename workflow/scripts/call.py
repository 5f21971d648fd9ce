"""Every rule: the call that the plan (experiments.plan) makes for it."""

from experiments.running.logs import job

with job(snakemake.log[0]) as stamps:
    snakemake.params.call.run()
    stamps.update(snakemake.params.stamps.write())

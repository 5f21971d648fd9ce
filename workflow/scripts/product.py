"""A table, a figure or a text: the call that the plan makes for it."""

from experiments.plan.call import Call
from experiments.running.logs import job

with job(snakemake.log[0]):
    Call(snakemake.params.function, snakemake.params.given).run()

"""A table, a figure or a text: the call that the plan makes for it."""

from experiments.jobs.inputs import placed
from experiments.plan.call import Call
from experiments.running.logs import job

with job(snakemake.log[0]):
    given = placed(snakemake.params.given, [*snakemake.input, *snakemake.output])
    Call(snakemake.params.function, given).run()

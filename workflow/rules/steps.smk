# The steps of the plan: motions of the upper body, recordings with what the observer makes of them, fits, networks,
# estimates, detectors, reactions, scores. A rule each, since no two have the same number of files; its name is that of
# its log.
# Memory [MB] and time [min] of each kind are those of the default scale, doubled. On a cluster, jobs of a group go into
# its queue together. What a job reads and gets is worked out when it is asked for: each start of a job on a cluster
# reads these rules.

KINDS = {
    "motion": Kind("motions", priority=30, mem_mb=500, runtime=20),
    "collect": Kind("walks", priority=20, mem_mb=2400, runtime=30),
    "fit": Kind("fits", priority=10, mem_mb=4000, runtime=10),
    "train": Kind("networks", priority=10, mem_mb=6000, runtime=60, gpus=min(GPUS, 1)),
    "estimate": Kind("estimates", priority=0, mem_mb=4000, runtime=30),
    "detect": Kind("scores", priority=0, mem_mb=3000, runtime=20),
    "watch": Kind("scores", priority=0, mem_mb=3000, runtime=20),
    "react": Kind("scores", priority=0, mem_mb=3000, runtime=60),
    "score": Kind("scores", priority=0, mem_mb=500, runtime=5),
}

for name, step in STEPS.items():

    rule:
        name:
            name
        input:
            lambda w, step=step: step.job.inputs,
        output:
            ensure(step.outputs, non_empty=True),
        log:
            f"{LOGS}/{step.work.job}.log",
        priority: KINDS[step.work.kind].priority
        group:
            KINDS[step.work.kind].group
        threads: 1
        resources:
            mem_mb=growing(KINDS[step.work.kind].mem_mb),
            runtime=KINDS[step.work.kind].runtime,
            gpu=KINDS[step.work.kind].gpus,
        params:
            call=lambda w, step=step: step.job.call,
            given=lambda w, step=step: step.job.given,
            stamps=lambda w, step=step: step.job.stamps,
        script:
            "../scripts/call.py"

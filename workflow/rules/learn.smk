# Small trainings go into the queue of a cluster together. Those that take their weights from a stack cannot: a stack may
# wait for one of them.
TOGETHER = None if SETTINGS.stacks.side_by_side else "networks"


rule fit:
    # Formulas of friction, fitted to the recordings from which networks learn. Rows: ./reproduce sheet fits
    input:
        recordings=collect(
            "<results>/{set.robot}/recordings/{set.name}",
            set=lookup("{robot}/{method}/recordings", within=SHEETS.fits),
        ),
        residuals=collect(
            "<results>/{set.robot}/residuals/{set.name}",
            set=lookup("{robot}/{method}/residuals", within=SHEETS.fits),
        ),
    output:
        "<results>/{robot}/fits/{method}.json",
    log:
        "<logs>/fit/{robot}/{method}.log",
    priority: 10
    group:
        "fits"
    resources:
        **LIMITS.of("fit"),
    params:
        given=JOBS.fit,
        code=code("fit", lambda w: JOBS.modules_of(w, [w.method])),
    script:
        "../scripts/fit.py"


rule train_stack:
    # Networks of one shape side by side on a GPU (docs/notes/training.md); where each learns alone, no job asks for
    # this. Rows: ./reproduce sheet stacks
    input:
        recordings=collect(
            "<results>/{set.robot}/recordings/{set.name}",
            set=lookup("{stack}/recordings", within=SHEETS.stacks),
        ),
        residuals=collect(
            "<results>/{set.robot}/residuals/{set.name}",
            set=lookup("{stack}/residuals", within=SHEETS.stacks),
        ),
        starts=collect(
            "<results>/{network.robot}/networks/{network.name}/weights.safetensors",
            network=lookup("{stack}/networks", within=SHEETS.stacks),
        ),
        fits=collect(
            "<results>/{fit.robot}/fits/{fit.name}.json",
            fit=lookup("{stack}/fits", within=SHEETS.stacks),
        ),
    output:
        "<results>/stacks/{stack}.safetensors",
    log:
        "<logs>/train_stack/{stack}.log",
    wildcard_constraints:
        stack=one_of(JOBS.stacks.members),
    priority: 15
    group:
        "stacks"
    resources:
        **LIMITS.of("train_stack"),
        gpu=min(GPUS, 1),
    params:
        given=JOBS.train_stack,
        code=code("train_stack"),
    script:
        "../scripts/train_stack.py"


rule train:
    # One network (section 4.4), from recordings; fine-tuned, from the weights of another one; with a fit, on what this
    # leaves of the uncertainty; on a GPU, from what it learned in a stack. Rows: ./reproduce sheet networks
    input:
        recordings=collect(
            "<results>/{set.robot}/recordings/{set.name}",
            set=lookup("{robot}/{method}-{limb}-s{seed}/recordings", within=SHEETS.networks),
        ),
        residuals=collect(
            "<results>/{set.robot}/residuals/{set.name}",
            set=lookup("{robot}/{method}-{limb}-s{seed}/residuals", within=SHEETS.networks),
        ),
        start=collect(
            "<results>/{network.robot}/networks/{network.name}/weights.safetensors",
            network=lookup("{robot}/{method}-{limb}-s{seed}/networks", within=SHEETS.networks),
        ),
        fitted=collect(
            "<results>/{fit.robot}/fits/{fit.name}.json",
            fit=lookup("{robot}/{method}-{limb}-s{seed}/fits", within=SHEETS.networks),
        ),
        stack=collect(
            "<results>/stacks/{stack}.safetensors",
            stack=lookup("{robot}/{method}-{limb}-s{seed}/stacks", within=SHEETS.networks),
        ),
    output:
        # Its checkpoint is none: a training that was killed goes on from its last epoch.
        weights="<results>/{robot}/networks/{method}-{limb}-s{seed}/weights.safetensors",
        metrics="<results>/{robot}/networks/{method}-{limb}-s{seed}/metrics.csv",
        run="<results>/{robot}/networks/{method}-{limb}-s{seed}/run.json",
    log:
        "<logs>/train/{robot}/{method}-{limb}-s{seed}.log",
    priority: 10
    group:
        TOGETHER
    resources:
        **LIMITS.of("train"),
        gpu=lambda w: 0 if "lesson" in JOBS.train(w) else min(GPUS, 1),
    params:
        seeds=lookup("{robot}/{method}-{limb}-s{seed}/seeds", within=SHEETS.networks),
        given=JOBS.train,
        code=code("train", JOBS.trained_by),
    script:
        "../scripts/train.py"

# Small trainings go into the queue of a cluster together. Those that take their weights from a stack cannot: a stack may
# wait for one of them.
NETWORKS = None if SETTINGS.stacks.side_by_side else "networks"


rule fit:
    # Formulas of friction, fitted to the recordings from which networks learn.
    input:
        sets=needed(JOBS.fit, "training"),
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
    # this.
    input:
        read=lambda w: made_by_jobs(JOBS.read_by_stack(w)),
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
    # One network (section 4.4). Its checkpoint is no output: a training that was killed goes on from its last epoch.
    input:
        recordings=needed(JOBS.train, "recordings"),
        residuals=needed(JOBS.train, "residuals"),
        start=needed(JOBS.train, "start"),
        lesson=needed(JOBS.train, "lesson"),
    output:
        weights="<results>/{robot}/networks/{method}-{limb}-s{seed}/weights.safetensors",
        metrics="<results>/{robot}/networks/{method}-{limb}-s{seed}/metrics.csv",
        run="<results>/{robot}/networks/{method}-{limb}-s{seed}/run.json",
    log:
        "<logs>/train/{robot}/{method}-{limb}-s{seed}.log",
    wildcard_constraints:
        method=one_of(PLAN.trained),
    priority: 10
    group:
        NETWORKS
    resources:
        **LIMITS.of("train"),
        gpu=lambda w: 0 if "lesson" in JOBS.train(w) else min(GPUS, 1),
    params:
        given=JOBS.train,
        code=code("train"),
    script:
        "../scripts/train.py"


rule train_gray:
    # A network that learns what a fitted formula of friction leaves of the uncertainty.
    input:
        recordings=needed(JOBS.train_gray, "recordings"),
        residuals=needed(JOBS.train_gray, "residuals"),
        fitted=needed(JOBS.train_gray, "fitted"),
        lesson=needed(JOBS.train_gray, "lesson"),
    output:
        weights="<results>/{robot}/networks/{method}-{limb}-s{seed}/weights.safetensors",
        metrics="<results>/{robot}/networks/{method}-{limb}-s{seed}/metrics.csv",
        run="<results>/{robot}/networks/{method}-{limb}-s{seed}/run.json",
    log:
        "<logs>/train/{robot}/{method}-{limb}-s{seed}.log",
    wildcard_constraints:
        method=one_of(PLAN.trained_gray),
    priority: 10
    group:
        NETWORKS
    resources:
        **LIMITS.of("train"),
        gpu=lambda w: 0 if "lesson" in JOBS.train_gray(w) else min(GPUS, 1),
    params:
        given=JOBS.train_gray,
        code=code("train_gray"),
    script:
        "../scripts/train_gray.py"

rule motion:
    # A random motion of the upper body, which all robots share.
    output:
        multiext("<results>/motions/{motion}/s{seed}", ".parquet", ".json"),
    log:
        "<logs>/motion/{motion}-s{seed}.log",
    priority: 30
    group:
        "motions"
    resources:
        **LIMITS.of("motion"),
    params:
        given=JOBS.motion,
        code=code("motion"),
    script:
        "../scripts/motion.py"


rule collect:
    # Recordings of a walk, a set: one file for each seed. All sets: ./reproduce sheet sets
    input:
        motions=collect(
            "<results>/motions/{motion}.parquet",
            motion=lookup("{robot}/{scenario}/{level}/motions", within=SHEETS.sets),
        ),
    output:
        recordings=let_go(directory("<results>/{robot}/recordings/{scenario}/{level}")),
    log:
        "<logs>/collect/{robot}/{scenario}-{level}.log",
    priority: 20
    group:
        "walks"
    resources:
        **LIMITS.of("collect"),
        disk_mb=SIZES.recordings,
    params:
        given=JOBS.collect,
        code=code("collect"),
    script:
        "../scripts/collect.py"


rule observe:
    # What the momentum observer makes of them (section 3).
    input:
        recordings=rules.collect.output.recordings,
    output:
        residuals=let_go(directory("<results>/{robot}/residuals/{scenario}/{level}")),
    log:
        "<logs>/observe/{robot}/{scenario}-{level}.log",
    priority: 20
    group:
        "residuals"
    resources:
        **LIMITS.of("observe"),
        disk_mb=SIZES.residuals,
    params:
        seeds=lookup("{robot}/{scenario}/{level}/seeds", within=SHEETS.sets),
        given=JOBS.observe,
        code=code("observe"),
    script:
        "../scripts/observe.py"

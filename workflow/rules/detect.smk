rule detect:
    # Detectors of a robot: thresholds, false alarms, and which collisions they find (section 5.3).
    input:
        sets=needed(JOBS.detect, "walks"),
    output:
        expand("<results>/{{robot}}/detection/{name}.csv", name=FILES),
    log:
        "<logs>/detect/{robot}.log",
    group:
        "scores"
    resources:
        **LIMITS.of("detect"),
    params:
        given=JOBS.detect,
        code=code("detect"),
    script:
        "../scripts/detect.py"


rule watch:
    # Thresholds of limbs that are watched all the time, and of the feet's sensors.
    input:
        recordings=needed(JOBS.watch, "quiet"),
        networks=needed(JOBS.watch, "runs"),
    output:
        "<results>/{robot}/reactions/thresholds.csv",
    log:
        "<logs>/watch/{robot}.log",
    group:
        "scores"
    resources:
        **LIMITS.of("watch"),
    params:
        given=JOBS.watch,
        code=code("watch", JOBS.watched_by),
    script:
        "../scripts/watch.py"


rule react:
    # A robot walks into an obstacle, or is pushed, and reacts (section 5.4); the course of the first walk is kept.
    input:
        thresholds=needed(JOBS.react, "thresholds"),
        networks=needed(JOBS.react, "runs"),
    output:
        "<results>/{robot}/reactions/{case}.csv",
        multiext("<results>/{robot}/reactions/{case}", ".parquet", ".json"),
    log:
        "<logs>/react/{robot}/{case}.log",
    wildcard_constraints:
        case=one_of(PLAN.pushed_cases),
    group:
        "scores"
    resources:
        **LIMITS.of("react"),
    params:
        given=JOBS.react,
        code=code("react", JOBS.watched_by),
    script:
        "../scripts/react.py"


use rule react as walk_freely with:
    # The same where nothing is in the way: how often it reacts to nothing.
    output:
        "<results>/{robot}/reactions/{case}.csv",
    wildcard_constraints:
        case=one_of(PLAN.free_cases),

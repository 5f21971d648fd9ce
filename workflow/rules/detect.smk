rule detect:
    # Detectors of a robot: thresholds, false alarms, and which collisions they find (section 5.3). The walks on which
    # they are tried: ./reproduce sheet detectors
    input:
        recordings=collect(
            "<results>/{set.robot}/recordings/{set.name}",
            set=lookup("{robot}/recordings", within=SHEETS.detectors),
        ),
        residuals=collect(
            "<results>/{set.robot}/residuals/{set.name}",
            set=lookup("{robot}/residuals", within=SHEETS.detectors),
        ),
        estimates=collect(
            "<results>/{set.robot}/estimates/{set.name}",
            set=lookup("{robot}/estimates", within=SHEETS.detectors),
        ),
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
    # Thresholds of limbs that are watched all the time, and of the feet's sensors. Rows: ./reproduce sheet watched
    input:
        recordings=collect(
            "<results>/{set.robot}/recordings/{set.name}",
            set=lookup("{robot}/recordings", within=SHEETS.watched),
        ),
        networks=collect(
            "<results>/{network.robot}/networks/{network.name}/{file}",
            network=lookup("{robot}/networks", within=SHEETS.watched),
            file=TRAINED,
        ),
        fits=collect(
            "<results>/{fit.robot}/fits/{fit.name}.json",
            fit=lookup("{robot}/fits", within=SHEETS.watched),
        ),
    output:
        "<results>/{robot}/reactions/thresholds.csv",
    log:
        "<logs>/watch/{robot}.log",
    group:
        "scores"
    resources:
        **LIMITS.of("watch"),
    params:
        seeds=lookup("{robot}/seeds", within=SHEETS.watched),
        given=JOBS.watch,
        code=code("watch", JOBS.watched_by),
    script:
        "../scripts/watch.py"


rule react:
    # A robot walks into an obstacle, or is pushed, and reacts (section 5.4); the course of the first walk is kept. What
    # runs in the loop: ./reproduce sheet reactions
    input:
        thresholds=[
            "<results>/{robot}/detection/thresholds.csv",
            "<results>/{robot}/reactions/thresholds.csv",
        ],
        networks=collect(
            "<results>/{network.robot}/networks/{network.name}/{file}",
            network=lookup("{robot}/{case}/networks", within=SHEETS.reactions),
            file=TRAINED,
        ),
        fits=collect(
            "<results>/{fit.robot}/fits/{fit.name}.json",
            fit=lookup("{robot}/{case}/fits", within=SHEETS.reactions),
        ),
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

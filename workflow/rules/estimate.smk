rule estimate:
    # The external torque of a test by every method that a table or figure shows of it.
    input:
        recordings=needed(JOBS.estimate, "recordings"),
        residuals=needed(JOBS.estimate, "residuals"),
        networks=needed(JOBS.estimate, "runs"),
    output:
        estimates=let_go(directory("<results>/{robot}/estimates/{scenario}/{level}")),
    log:
        "<logs>/estimate/{robot}/{scenario}-{level}.log",
    group:
        "estimates"
    resources:
        **LIMITS.of("estimate"),
        disk_mb=SIZES.estimates,
    params:
        given=JOBS.estimate,
        code=lambda w: code_hash("experiments.jobs.estimates", *JOBS.estimated_by(w)),
    script:
        "../scripts/estimate.py"


rule score:
    # Errors of all of these estimates, of all robots together where the level is theirs.
    input:
        sets=needed(JOBS.score, "runs"),
    output:
        "<results>/scores/{scenario}/{level}.csv",
    log:
        "<logs>/score/{scenario}-{level}.log",
    group:
        "scores"
    resources:
        **LIMITS.of("score"),
    params:
        given=JOBS.score,
        code=lambda w: code_hash("experiments.evaluation.measure.estimates.scores", *JOBS.measured_by(w)),
    script:
        "../scripts/score.py"

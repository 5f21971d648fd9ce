# What `all` does not ask for: trials of methods, films and the documentation.


rule falls:
    # A robot's falls with random torques of several sizes.
    output:
        "<results>/{robot}/falls.csv",
    log:
        "<logs>/falls/{robot}.log",
    group:
        "walks"
    resources:
        **LIMITS.of("falls"),
    params:
        given=JOBS.falls,
        code=code("falls"),
    script:
        "../scripts/falls.py"


rule trial:
    # Variants of methods on walks of their own (configs/trials.yaml); their networks are trained as all others are.
    input:
        recordings=collect(
            "<results>/{set.robot}/recordings/{set.name}",
            set=lookup("{trial}/recordings", within=SHOWN),
        ),
        residuals=collect("<results>/{set.robot}/residuals/{set.name}", set=lookup("{trial}/residuals", within=SHOWN)),
        networks=collect(
            "<results>/{network.robot}/networks/{network.name}/{file}",
            network=lookup("{trial}/networks", within=SHOWN),
            file=TRAINED,
        ),
        fits=collect("<results>/{fit.robot}/fits/{fit.name}.json", fit=lookup("{trial}/fits", within=SHOWN)),
        falls=collect("<results>/{robot}/falls.csv", robot=lookup("{trial}/falls", within=SHOWN)),
    output:
        multiext("<results>/trials/{trial}", ".csv", ".tex", ".md"),
    log:
        "<logs>/trials/{trial}.log",
    wildcard_constraints:
        trial=one_of(PLAN.made_by("trial")),
    group:
        "tables"
    resources:
        **LIMITS.of("{trial}"),
    params:
        **product("{trial}"),
    script:
        "../scripts/product.py"


rule films:
    # Films of walks into obstacles.
    input:
        courses=collect(
            "<results>/{own.robot}/reactions/{own.name}.parquet",
            own=lookup("films/courses", within=SHOWN),
        ),
    output:
        [flagged(name) for name in PLAN.product("films").outputs],
    log:
        "<logs>/films.log",
    group:
        "tables"
    resources:
        **LIMITS.of("films"),
    params:
        **product("films"),
    script:
        "../scripts/product.py"


rule docs:
    # The documentation as pages, from its documents, captions, modules and templates.
    input:
        files=lookup("docs/files", within=SHOWN),
    output:
        directory("<results>/docs"),
    log:
        "<logs>/docs.log",
    group:
        "tables"
    resources:
        **LIMITS.of("docs"),
    params:
        **product("docs"),
    script:
        "../scripts/product.py"

# Every table and figure by its name. Its row, in src/experiments/plan/items, says what makes it and what it reads of what
# its rule names; `./reproduce sheet shown table_07` prints the latter.


rule table:
    # A table: of errors, of what detectors or reactions find, of recordings, of networks, or of other tables.
    input:
        scores=collect("<results>/scores/{test}.csv", test=lookup("{table}/scores", within=SHOWN)),
        detections=collect(
            "<results>/{own.robot}/detection/{own.name}.csv",
            own=lookup("{table}/detections", within=SHOWN),
        ),
        reactions=collect(
            "<results>/{own.robot}/reactions/{own.name}.csv",
            own=lookup("{table}/reactions", within=SHOWN),
        ),
        recordings=collect(
            "<results>/{set.robot}/recordings/{set.name}",
            set=lookup("{table}/recordings", within=SHOWN),
        ),
        residuals=collect("<results>/{set.robot}/residuals/{set.name}", set=lookup("{table}/residuals", within=SHOWN)),
        estimates=collect("<results>/{set.robot}/estimates/{set.name}", set=lookup("{table}/estimates", within=SHOWN)),
        networks=collect(
            "<results>/{network.robot}/networks/{network.name}/{file}",
            network=lookup("{table}/networks", within=SHOWN),
            file=TRAINED,
        ),
        tables=collect("<tables>/{name}.csv", name=lookup("{table}/tables", within=SHOWN)),
    output:
        multiext("<tables>/{table}", ".csv", ".tex", ".md"),
    log:
        "<logs>/table/{table}.log",
    wildcard_constraints:
        table=one_of(PLAN.made_by("table")),
    group:
        "tables"
    resources:
        **LIMITS.of("{table}"),
    params:
        **product("{table}"),
    script:
        "../scripts/product.py"


rule figure:
    # A figure: of errors, detectors, reactions with the courses of walks, recordings, networks, or a kept file.
    input:
        scores=collect("<results>/scores/{test}.csv", test=lookup("{figure}/scores", within=SHOWN)),
        detections=collect(
            "<results>/{own.robot}/detection/{own.name}.csv",
            own=lookup("{figure}/detections", within=SHOWN),
        ),
        reactions=collect(
            "<results>/{own.robot}/reactions/{own.name}.csv",
            own=lookup("{figure}/reactions", within=SHOWN),
        ),
        courses=collect(
            "<results>/{own.robot}/reactions/{own.name}.parquet",
            own=lookup("{figure}/courses", within=SHOWN),
        ),
        recordings=collect(
            "<results>/{set.robot}/recordings/{set.name}",
            set=lookup("{figure}/recordings", within=SHOWN),
        ),
        estimates=collect("<results>/{set.robot}/estimates/{set.name}", set=lookup("{figure}/estimates", within=SHOWN)),
        networks=collect(
            "<results>/{network.robot}/networks/{network.name}/{file}",
            network=lookup("{figure}/networks", within=SHOWN),
            file=TRAINED,
        ),
        files=lookup("{figure}/files", within=SHOWN),
    output:
        multiext("<figures>/{figure}", ".pdf", ".svg", ".csv"),
        shown("<figures>/{figure}.png"),
    log:
        "<logs>/figure/{figure}.log",
    wildcard_constraints:
        figure=one_of(PLAN.made_by("figure")),
    group:
        "tables"
    resources:
        **LIMITS.of("{figure}"),
    params:
        **product("{figure}"),
        caption=lambda w: PLAN.folders.captions / "figures" / f"{w.figure}.rst",
    script:
        "../scripts/product.py"


rule figure_with_bars:
    # A figure of walks, with the errors in a file of their own.
    input:
        recordings=collect(
            "<results>/{set.robot}/recordings/{set.name}",
            set=lookup("{figure}/recordings", within=SHOWN),
        ),
        residuals=collect("<results>/{set.robot}/residuals/{set.name}", set=lookup("{figure}/residuals", within=SHOWN)),
        estimates=collect("<results>/{set.robot}/estimates/{set.name}", set=lookup("{figure}/estimates", within=SHOWN)),
        scores=collect("<results>/scores/{test}.csv", test=lookup("{figure}/scores", within=SHOWN)),
    output:
        multiext("<figures>/{figure}", ".pdf", ".svg", ".csv"),
        shown("<figures>/{figure}.png"),
        "<figures>/{figure}_bars.csv",
    log:
        "<logs>/figure/{figure}.log",
    wildcard_constraints:
        figure=one_of(PLAN.made_by("figure_with_bars")),
    group:
        "tables"
    resources:
        **LIMITS.of("{figure}"),
    params:
        **product("{figure}"),
        caption=lambda w: PLAN.folders.captions / "figures" / f"{w.figure}.rst",
    script:
        "../scripts/product.py"


rule figure_with_table:
    # What networks predict of their own errors, as a figure and a table.
    input:
        scores=collect("<results>/scores/{test}.csv", test=lookup("{figure}/scores", within=SHOWN)),
        recordings=collect(
            "<results>/{set.robot}/recordings/{set.name}",
            set=lookup("{figure}/recordings", within=SHOWN),
        ),
        residuals=collect("<results>/{set.robot}/residuals/{set.name}", set=lookup("{figure}/residuals", within=SHOWN)),
        estimates=collect("<results>/{set.robot}/estimates/{set.name}", set=lookup("{figure}/estimates", within=SHOWN)),
        networks=collect(
            "<results>/{network.robot}/networks/{network.name}/{file}",
            network=lookup("{figure}/networks", within=SHOWN),
            file=TRAINED,
        ),
    output:
        multiext("<figures>/{figure}", ".pdf", ".svg", ".csv"),
        shown("<figures>/{figure}.png"),
        multiext("<tables>/{figure}", ".csv", ".tex", ".md"),
    log:
        "<logs>/figure/{figure}.log",
    wildcard_constraints:
        figure=one_of(PLAN.made_by("figure_with_table")),
    group:
        "tables"
    resources:
        **LIMITS.of("{figure}"),
    params:
        **product("{figure}"),
        caption=lambda w: PLAN.folders.captions / "figures" / f"{w.figure}.rst",
    script:
        "../scripts/product.py"


rule figure_10:
    # Hits of a knee in the air, and in a figure of their own those of a knee on the ground.
    input:
        recordings=collect(
            "<results>/{set.robot}/recordings/{set.name}",
            set=lookup("figure_10/recordings", within=SHOWN),
        ),
        residuals=collect(
            "<results>/{set.robot}/residuals/{set.name}",
            set=lookup("figure_10/residuals", within=SHOWN),
        ),
        estimates=collect(
            "<results>/{set.robot}/estimates/{set.name}",
            set=lookup("figure_10/estimates", within=SHOWN),
        ),
        scores=collect("<results>/scores/{test}.csv", test=lookup("figure_10/scores", within=SHOWN)),
    output:
        multiext("<figures>/figure_10", ".pdf", ".svg", ".csv"),
        flagged("<figures>/figure_10.png"),
        multiext("<figures>/figure_10_support", ".pdf", ".svg", ".csv"),
        flagged("<figures>/figure_10_support.png"),
        "<figures>/figure_10_bars.csv",
    log:
        "<logs>/figure/figure_10.log",
    group:
        "tables"
    resources:
        **LIMITS.of("figure_10"),
    params:
        **product("figure_10"),
    script:
        "../scripts/product.py"


rule bode:
    # The observer's response in a figure of two joints, and in one of the whole leg.
    input:
        scores=collect("<results>/scores/{test}.csv", test=lookup("bode/scores", within=SHOWN)),
    output:
        multiext("<figures>/bode", ".pdf", ".svg", ".csv"),
        flagged("<figures>/bode.png"),
        multiext("<figures>/bode_all", ".pdf", ".svg", ".csv"),
        flagged("<figures>/bode_all.png"),
    log:
        "<logs>/figure/bode.log",
    group:
        "tables"
    resources:
        **LIMITS.of("bode"),
    params:
        **product("bode"),
    script:
        "../scripts/product.py"


rule claims:
    # The statements of the paper, each with its verdict, as a table and as figures.
    input:
        tables=collect("<tables>/{name}.csv", name=lookup("claims/tables", within=SHOWN)),
        scores=collect("<results>/scores/{test}.csv", test=lookup("claims/scores", within=SHOWN)),
        networks=collect(
            "<results>/{network.robot}/networks/{network.name}/{file}",
            network=lookup("claims/networks", within=SHOWN),
            file=TRAINED,
        ),
    output:
        multiext("<figures>/claims", ".pdf", ".svg", ".csv"),
        flagged("<figures>/claims.png"),
        multiext("<figures>/claims_own", ".pdf", ".svg", ".csv"),
        flagged("<figures>/claims_own.png"),
        multiext("<tables>/claims", ".csv", ".tex", ".md"),
    log:
        "<logs>/table/claims.log",
    group:
        "tables"
    resources:
        **LIMITS.of("claims"),
    params:
        **product("claims"),
    script:
        "../scripts/product.py"


rule pictures:
    # Drawings of the method and of the robot, and the film of a push.
    input:
        recordings=collect(
            "<results>/{set.robot}/recordings/{set.name}",
            set=lookup("pictures/recordings", within=SHOWN),
        ),
        residuals=collect("<results>/{set.robot}/residuals/{set.name}", set=lookup("pictures/residuals", within=SHOWN)),
        estimates=collect("<results>/{set.robot}/estimates/{set.name}", set=lookup("pictures/estimates", within=SHOWN)),
        detections=collect(
            "<results>/{own.robot}/detection/{own.name}.csv",
            own=lookup("pictures/detections", within=SHOWN),
        ),
    output:
        [flagged(name) for name in PLAN.product("pictures").outputs],
    log:
        "<logs>/figure/pictures.log",
    group:
        "tables"
    resources:
        **LIMITS.of("pictures"),
    params:
        **product("pictures"),
    script:
        "../scripts/product.py"


rule tables:
    # All tables.
    input:
        expand("<tables>/{table}.{ending}", table=PLAN.tables, ending=["csv", "tex", "md"]),


rule figures:
    # All figures.
    input:
        expand("<figures>/{figure}.{ending}", figure=PLAN.figures, ending=["pdf", "svg", "png", "csv"]),


rule paper_core:
    # Section 5.1 alone: forward walking and motion of the plant.
    input:
        expand("<tables>/{table}.{ending}", table=["table_05", "table_06"], ending=["csv", "tex", "md"]),
        expand("<figures>/figure_05.{ending}", ending=["pdf", "svg", "png", "csv"]),

# Every table and figure by its name; what each is made from stands in src/experiments/plan.


rule table:
    input:
        made_from=lambda w: PLAN.product(w.table).inputs,
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
        function=lambda w: PLAN.product(w.table).function,
        given=lambda w: PLAN.product(w.table).arguments,
        code=lambda w: PLAN.product(w.table).code,
    script:
        "../scripts/product.py"


use rule table as figure with:
    input:
        made_from=lambda w: PLAN.product(w.figure).inputs,
    output:
        multiext("<figures>/{figure}", ".pdf", ".svg", ".csv"),
        shown("<figures>/{figure}.png"),
    log:
        "<logs>/figure/{figure}.log",
    wildcard_constraints:
        figure=one_of(PLAN.made_by("figure")),
    resources:
        **LIMITS.of("{figure}"),
    params:
        function=lambda w: PLAN.product(w.figure).function,
        given=lambda w: PLAN.product(w.figure).arguments,
        code=lambda w: PLAN.product(w.figure).code,
        caption=lambda w: PLAN.folders.captions / "figures" / f"{w.figure}.rst",


use rule figure as figure_with_bars with:
    # A figure whose bars have a file of their own.
    output:
        multiext("<figures>/{figure}", ".pdf", ".svg", ".csv"),
        shown("<figures>/{figure}.png"),
        "<figures>/{figure}_bars.csv",
    wildcard_constraints:
        figure=one_of(PLAN.made_by("figure_with_bars")),


use rule figure as figure_with_table with:
    # A figure that is a table too.
    output:
        multiext("<figures>/{figure}", ".pdf", ".svg", ".csv"),
        shown("<figures>/{figure}.png"),
        multiext("<tables>/{figure}", ".csv", ".tex", ".md"),
    wildcard_constraints:
        figure=one_of(PLAN.made_by("figure_with_table")),


use rule table as figure_10 with:
    # Hits of a knee in the air, and in a figure of their own those of a knee on the ground.
    input:
        made_from=PLAN.product("figure_10").inputs,
    output:
        [flagged(name) for name in PLAN.product("figure_10").outputs],
    log:
        "<logs>/figure/figure_10.log",
    resources:
        **LIMITS.of("figure_10"),
    params:
        **PLAN.product("figure_10").params,


use rule table as bode with:
    # The observer's response in a figure of two joints, and in one of the whole leg.
    input:
        made_from=PLAN.product("bode").inputs,
    output:
        [flagged(name) for name in PLAN.product("bode").outputs],
    log:
        "<logs>/figure/bode.log",
    resources:
        **LIMITS.of("bode"),
    params:
        **PLAN.product("bode").params,


use rule table as claims with:
    # The statements of the paper, each with its verdict, as a table and as figures.
    input:
        tables=PLAN.product("claims").reads("tables"),
        scores=PLAN.product("claims").reads("scores"),
        networks=PLAN.product("claims").reads("folders"),
    output:
        [flagged(name) for name in PLAN.product("claims").outputs],
    log:
        "<logs>/table/claims.log",
    resources:
        **LIMITS.of("claims"),
    params:
        **PLAN.product("claims").params,


use rule table as pictures with:
    # Drawings of the method and of the robot, and the film of a push.
    input:
        made_from=PLAN.product("pictures").inputs,
    output:
        [flagged(name) for name in PLAN.product("pictures").outputs],
    log:
        "<logs>/figure/pictures.log",
    resources:
        **LIMITS.of("pictures"),
    params:
        **PLAN.product("pictures").params,


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

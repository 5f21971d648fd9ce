"""Intervals that hold what they say with few robots, walks and networks (docs/intervals.md); no configuration, no file.

`independent` and `few_clusters` have those of shares and rates, `clusters` those of values of few robots, `crossed`
those of runs that are a grid, `quantities` what is made of several numbers, `bounds` the verdict on a printed number.
"""

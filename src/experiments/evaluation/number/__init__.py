"""A number with its interval, the runs it is made of, and what the paper prints."""

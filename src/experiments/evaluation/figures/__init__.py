"""The paper's figures: a module a figure, named as its rule and its files."""

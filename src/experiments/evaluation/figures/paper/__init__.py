"""The figures that the paper has."""

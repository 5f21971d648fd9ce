"""The tables that the paper has."""

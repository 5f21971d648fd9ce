"""The tables: a module a table, named as its files."""

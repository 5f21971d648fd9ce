"""Walking controller, compiled; docs/notes/walking.md derives its laws."""

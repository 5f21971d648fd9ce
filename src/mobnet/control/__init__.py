"""Walking controller, compiled; docs/notes/0019-walking-controller.md derives its laws."""

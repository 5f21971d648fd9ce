"""What the steps of the workflow call: a module for each kind of step, which calls the library and writes files."""

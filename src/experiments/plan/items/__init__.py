"""The rows of tables and figures, in a module for each kind of what they read."""

"""Drawing that several figures share."""

"""Pages of the documentation that are made: results, reference, and the contents that the index of documents gives."""

"""An estimate beside the truth: what is read of one walk, and the errors that follow."""

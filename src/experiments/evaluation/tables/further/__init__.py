"""Tables that this artifact adds."""

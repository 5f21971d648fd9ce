"""Which recordings, networks and estimates a product needs, and which function makes each file of the workflow."""

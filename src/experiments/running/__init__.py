"""How jobs run: alone in a folder, in one environment, on a cluster or a GPU, with logs and accounts; no result."""

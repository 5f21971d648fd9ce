"""How jobs run, alone in a folder, in one environment, on a cluster or a GPU: logs, accounts, what a run shows."""

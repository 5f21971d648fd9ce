"""The experiments of the paper: what is planned, computed, measured and shown. The library is `mobnet`."""

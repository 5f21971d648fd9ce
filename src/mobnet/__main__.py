"""`python -m mobnet` is `mobnet`."""

import sys

from mobnet.commands import main

if __name__ == "__main__":
    sys.exit(main())

"""`python -m demo_game`."""

from __future__ import annotations

import sys

from demo_game.cli import main

if __name__ == "__main__":
    sys.exit(main())

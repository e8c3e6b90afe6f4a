"""`python -m demo_game`."""

from __future__ import annotations

import sys

from weather_ecs.errors import MissingExtraError


def main() -> int:
    """Run the game; returns the exit status, 1 where its pictures' library is missing."""
    try:
        from demo_game.cli import main as run
    except ModuleNotFoundError as error:
        if error.name != "PIL":
            raise
        print(f"demo_game: {MissingExtraError('demo', 'PIL')}", file=sys.stderr)
        return 1
    return run()


if __name__ == "__main__":
    sys.exit(main())

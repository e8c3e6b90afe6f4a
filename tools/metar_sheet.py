"""The walk under the sky of each METAR report of a file: `python -m tools.metar_sheet OUT REPORTS`.

REPORTS has one report a line, as tests/data/metars.txt; docs/metar.md shows the sheet of that.
"""

from __future__ import annotations

import sys
from pathlib import Path

from tools.stills import ALONG_THE_PATH, Stage, run, save_sheet

USAGE = "usage: python -m tools.metar_sheet OUT.jpg REPORTS.txt"


def reports_of(text: str) -> list[str]:
    """The reports of a file: one a line, # begins a remark."""
    lines = [line.strip() for line in text.splitlines()]
    return [line for line in lines if line and not line.startswith("#")]


def draw(out: Path, arguments: list[str]) -> None:
    """Render every report and write the sheet."""
    stage, pictures, texts = Stage(), [], []
    stage.look(*ALONG_THE_PATH)
    for report in reports_of(Path(arguments[0]).read_text(encoding="utf-8")):
        game = stage.game(metar=report)
        game.sky.be("noon")
        stage.settle(game)
        pictures.append(stage.still(game, seconds=20.0, frames=12))
        texts.append(report.removeprefix("METAR ").split(" RMK")[0])
        game.close()
    save_sheet(out, pictures, texts, lines=2)


def main(arguments: list[str]) -> int:
    """0, or 2 where an argument is missing."""
    return run(arguments, USAGE, draw, least=2)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

"""`python -m benchmarks NAME [--json FILE] [--quick]`, `python -m benchmarks --list`."""

from __future__ import annotations

import argparse
import importlib
import pkgutil
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import NoReturn

import benchmarks

NOT_BENCHMARKS = {"harness", "__main__"}


class OneLineParser(argparse.ArgumentParser):
    def error(self, message: str) -> NoReturn:
        self.exit(2, f"{self.prog}: {message}\n")


def names() -> list[str]:
    """Modules of the package that define `run`, in order of name."""
    found = [module.name for module in pkgutil.iter_modules(benchmarks.__path__)]
    candidates = [name for name in found if name not in NOT_BENCHMARKS and name[0] != "_"]
    return [n for n in candidates if hasattr(importlib.import_module(f"benchmarks.{n}"), "run")]


def main(arguments: Sequence[str] | None = None) -> int:
    parser = OneLineParser(prog="benchmarks", description=(benchmarks.__doc__ or "").strip())
    parser.add_argument("name", metavar="NAME", nargs="?")
    parser.add_argument("--list", action="store_true", help="names of all benchmarks")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the result there too")
    parser.add_argument("--quick", action="store_true", help="fewer and smaller cases")
    options = parser.parse_args(arguments)
    if options.list:
        print("\n".join(names()))
        return 0
    if options.name not in names():
        given = "no NAME" if options.name is None else f"unknown NAME {options.name!r}"
        parser.error(f"{given}, allowed: {', '.join(names())}")
    if options.json is not None and not options.json.absolute().parent.is_dir():
        parser.error(f"--json: no folder {options.json.absolute().parent}")
    result = importlib.import_module(f"benchmarks.{options.name}").run(options.quick)
    print(result.table())
    if options.json is not None:
        result.write(options.json)
    return 0


if __name__ == "__main__":
    sys.exit(main())

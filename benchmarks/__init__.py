"""Benchmarks: `python -m benchmarks NAME [--json FILE] [--quick]`.

A benchmark is a module of this package with `run(quick: bool) -> Result`; its name is the module's.
"""

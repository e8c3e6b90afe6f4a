"""Rain models that benchmarks compare, each behind the same face; see `models.model.Model`."""

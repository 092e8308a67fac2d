"""Measure every estimator on simulated arms whose truth is known: in come worlds, out go tables of errors."""

from benchmarks.estimators.bench import run

__all__ = ["run"]

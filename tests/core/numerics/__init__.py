"""Test core.numerics."""

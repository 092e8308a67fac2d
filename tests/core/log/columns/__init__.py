"""Test core.log.columns."""

"""Test core.diagnosis.search."""

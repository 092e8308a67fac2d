"""Test core.diagnosis.checks."""

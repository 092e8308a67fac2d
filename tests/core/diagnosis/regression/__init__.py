"""Test core.diagnosis.regression."""

"""Test core.diagnosis.dataset."""

"""Test core.document."""

"""Test core.identification."""

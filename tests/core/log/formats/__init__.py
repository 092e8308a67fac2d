"""Test core.log.formats."""

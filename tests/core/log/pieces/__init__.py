"""Test core.log.pieces."""

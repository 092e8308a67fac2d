"""Test core.document.model."""

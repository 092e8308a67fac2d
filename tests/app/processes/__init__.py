"""Test app.processes."""

"""Test app.jobs."""

"""Test app.auth."""

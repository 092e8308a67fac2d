"""Test app.lifecycle."""

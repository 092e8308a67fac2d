"""Test app.http."""

"""Test app.terminal.output."""

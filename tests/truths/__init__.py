"""Change one thing in a measured log or in its robot's description, and ask the diagnosis what it was."""

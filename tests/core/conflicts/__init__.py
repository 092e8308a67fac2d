"""Hold robots and logs against each other."""

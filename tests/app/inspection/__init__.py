"""Hold reading in a process of its own to what it promises."""

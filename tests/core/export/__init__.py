"""Hold the exported files to the engines that read them, and the round trips to what went in."""

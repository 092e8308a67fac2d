"""Hold the shipped log and the demonstration to what they promise."""

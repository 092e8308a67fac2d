"""Hold the base parameters against published tables and against numerical rank."""

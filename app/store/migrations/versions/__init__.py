"""Hold one step of the database's layout per file, in the order of their numbers."""

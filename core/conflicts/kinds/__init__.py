"""Hold one file per kind of conflict."""

"""Hold the store to its promises, on the embedded database and on PostgreSQL."""

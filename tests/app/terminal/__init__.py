"""Hold the commands to what they promise: words, tables, documents and exit codes."""

"""Write results for a terminal: documents come in, lines, tables, files and exit codes go out."""

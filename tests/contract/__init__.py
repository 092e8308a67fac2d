"""Hold the code to its shape: imports, sizes, docstrings, locks, vendored files, documents."""

"""Search for causes: in come rows and candidate causes, out goes the `SearchState` that it ends in."""

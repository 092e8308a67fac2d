"""Keep what outlives a request: in come records and bytes, out go the same after a restart."""

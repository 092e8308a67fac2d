"""Check what the search found: in comes a `SearchState`, out come findings, alternatives and lack of fit."""

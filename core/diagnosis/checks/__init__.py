"""Check what the search found: in comes a `Selection`, out come findings, alternatives and lack of fit."""

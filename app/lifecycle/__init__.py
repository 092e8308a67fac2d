"""Maintain what is kept for years: in comes a store, out comes a smaller one, a copy, or what is wrong."""

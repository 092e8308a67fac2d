"""Spoil entries of descriptions by seed, and count which of them an audit names: ``make audit SEED=n``."""

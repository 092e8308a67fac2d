"""Tests of core and app: laws, regimes, golden numbers with their source, and contracts on the code's shape."""

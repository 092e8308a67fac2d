"""Test core and app: laws, regimes, golden numbers with source, and contracts on the code's shape."""

"""Name the version in one place, because the service also runs from a checkout that was never installed.

A test keeps it equal to the version in pyproject.toml.
"""

VERSION = "0.1.0"

"""Say which version wrote a document."""

from importlib.metadata import PackageNotFoundError, version


def product_version() -> str:
    """Give the version of the package, or of this source where none is installed."""
    try:
        return version("veritorque")
    except PackageNotFoundError:
        return "0.1.0"

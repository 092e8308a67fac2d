"""Offer an identified robot as files, and document in what forms they come."""

from core.export.formats import FORMATS

ARTIFACTS = FORMATS
"""The files of a result by name: what is written as which media type."""

CONTENT = {
    form.media_type: {
        "schema": {"type": "string", "format": "binary"}
        if form.media_type == "application/x-matlab-data"
        else {"type": "string"}
    }
    for form in FORMATS.values()
}
"""The bodies of the answers for the contract, by media type."""

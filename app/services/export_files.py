"""Offer an identified robot as files, and document in what forms they come."""

from ...core.export.formats import FORMATS

ARTIFACTS = FORMATS
"""The files of a result by name: what is written as which media type."""

TRACES_FILE, TRACES_TYPE = "residuals.parquet", "application/vnd.apache.parquet"
"""The one file that is not written from the result: what the job computed instant by instant."""

BINARY = ("application/x-matlab-data", TRACES_TYPE)

CONTENT = {
    media_type: {
        "schema": {"type": "string", "format": "binary"} if media_type in BINARY else {"type": "string"}
    }
    for media_type in (*(form.media_type for form in FORMATS.values()), TRACES_TYPE)
}
"""The bodies of the answers for the contract, by media type."""

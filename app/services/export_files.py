"""Name the files of results for the contract: those that kinds write from a result, and the traces."""

from ..kinds.registry import KINDS

TRACES_FILE, TRACES_TYPE = "residuals.parquet", "application/vnd.apache.parquet"
"""The one file that is not written from the result: the torques and residuals of every sample."""
ARTIFACTS = {name: form for kind in KINDS.values() for name, form in kind.artifacts.items()}
"""The files of all kinds by name."""
BINARY = ("application/x-matlab-data", TRACES_TYPE)

CONTENT = {
    media_type: {
        "schema": {"type": "string", "format": "binary"} if media_type in BINARY else {"type": "string"}
    }
    for media_type in (*(form.media_type for form in ARTIFACTS.values()), TRACES_TYPE)
}
"""The bodies of the answers for the contract, by media type."""

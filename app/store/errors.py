"""Say what can go wrong with what is kept, in terms of the store."""


class KeyReusedError(Exception):
    """Say that a request came with a key that another request had before."""

    def __init__(self, key: str) -> None:
        super().__init__(key)
        self.key = key


class OverQuotaError(Exception):
    """Say that a tenant has as much of something as it may have."""

    def __init__(self, what: str, *, most: int, setting: str) -> None:
        super().__init__(what, most)
        self.what, self.most, self.setting = what, most, setting


class DamagedError(Exception):
    """Say that bytes are not what they were when they were kept."""

    def __init__(self, sha256: str, evidence: str) -> None:
        super().__init__(sha256, evidence)
        self.sha256, self.evidence = sha256, evidence


class UnavailableError(Exception):
    """Say that the database cannot be reached or written, and why."""

    def __init__(self, reason: str) -> None:
        super().__init__(reason)
        self.reason = reason

"""Name what is under test: the one place where these answers meet the product's own names."""

from typing import Any

from veritorque import IdentifyRequest, builtin_robot, diagnose, identify, log_from_arrays, read_log
from veritorque.core.log.model import JointLog, whole_rows

Document = dict[str, Any]

__all__ = [
    "Document",
    "IdentifyRequest",
    "JointLog",
    "builtin_robot",
    "diagnose",
    "identify",
    "log_from_arrays",
    "read_log",
    "whole_rows",
]

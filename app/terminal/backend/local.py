"""Compute in this process, on files: without a service or a database, and without keeping anything."""

import hashlib
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from ....core.errors import LogError, OptionError, RobotError
from ...json_text import json_bytes
from ..computing import COMPILING, limit_threads, share_compiled_kernels
from ..output.files import save
from ..output.streams import note, note_suspicions
from ..results import read_result
from .protocol import WHOLE, Document, FromUrdf, Progress, Study, require_whole


class LocalBackend:
    """Do the work here."""

    def __init__(self) -> None:
        limit_threads(1)

    def robots(self) -> list[Document]:
        """List the built-in robots."""
        from ...services.robot_descriptions import built_in_robots
        from ...services.serialisers import robot_summary

        return [robot_summary(robot) for robot in built_in_robots().values()]

    def robot(self, given: str, part: FromUrdf = WHOLE) -> Document:
        """Read a built-in robot, a description or a URDF.

        Raises
        ------
        RobotError
            If there is none, or it cannot be used.
        """
        from ....core.robot.plausibility import plausibility_warnings
        from ...services.robot_descriptions import built_in_descriptions, read_description, read_urdf

        known = built_in_descriptions()
        if given in known:
            require_whole(given, part)
            model, description = read_description(known[given])
        else:
            content = _robot_file(given, known)
            if content.lstrip()[:1] in (b"{", b"[") or given.endswith(".json"):
                from ...http.body.json_body import parse_json

                require_whole(given, part)
                model, description = read_description(parse_json(content, what=given))
            else:
                model, description = read_urdf(content, **vars(part))
        return {
            "id": given,
            "name": model.name,
            "joints": len(model.joints),
            "built_in": given in known,
            "suspicions": list(plausibility_warnings(model)),
            "description": description,
        }

    def base_parameters(self, given: str, part: FromUrdf = WHOLE) -> Document:
        """Say what motion of a robot can distinguish."""
        from ...kinds.base_parameters import base_parameters

        description = self.robot(given, part)["description"]
        _note_compilation()
        return {"robot": given} | base_parameters(description)

    def audit(self, given: str, part: FromUrdf, options: Document) -> Document:
        """Audit a robot's description without a log."""
        from ...kinds.audit import audit_description

        return audit_description(self.robot(given, part)["description"], options)

    def run(self, study: Study, progress: Progress, report: Path | None) -> bytes:
        """Compute; what cannot succeed is refused before the solver is loaded.

        Raises
        ------
        VeritorqueError
            If the robot, the logs or the options do not allow it.
        """
        from ...jobs.computation import Computation, LogBlob, Workspace
        from ...jobs.compute import compute
        from ...kinds.registry import kind_of
        from ...services.log_names import log_name

        progress("load", 0.0)
        kind, options = kind_of(study.kind), dict(study.options)
        seen = self.robot(study.robot, study.part)
        robot = seen["description"]
        note_suspicions(seen["suspicions"])
        kind.read_options(options)
        mapping = None if study.mapping is None else dict(study.mapping)
        digests = {path: _hash(path) for path in study.logs}
        logs = tuple(LogBlob(digests[path], log_name(path.name), mapping) for path in study.logs)
        _note_compilation()
        earlier = _result_file(kind.reference(options))
        if earlier is not None:
            digests[earlier] = _hash(earlier)
        reference = None if earlier is None else digests[earlier]
        computation = Computation(kind.name, robot, logs, options, reference)
        with tempfile.TemporaryDirectory() as folder:
            traces = None if report is None else Path(folder) / "residuals.parquet"
            workspace = Workspace({digest: path for path, digest in digests.items()}, traces)
            with _naming_what_suggests_a_mapping():
                document = compute(computation, workspace, progress)
            if report is not None:
                save(report, kind.report(document, traces).encode())
            return json_bytes(document)


@contextmanager
def _naming_what_suggests_a_mapping() -> Iterator[None]:
    """Name the command that suggests a mapping, where a log lacks columns of the usual names."""
    try:
        yield
    except LogError as error:
        if "looked_for" in error.evidence:
            error.remedy += "; veritorque logs check LOG suggests a mapping"
        raise


def _robot_file(given: str, known: Document) -> bytes:
    try:
        return Path(given).read_bytes()
    except OSError as error:
        raise RobotError(
            f"there is no robot {given}",
            evidence={"built_in": list(known), "reason": error.strerror},
            remedy="name a built-in robot, or the file of a description or URDF",
        ) from error


def _hash(path: Path) -> str:
    try:
        with path.open("rb") as stream:
            return hashlib.file_digest(stream, "sha256").hexdigest()
    except OSError as error:
        raise LogError(
            f"{path} cannot be read", evidence={"reason": error.strerror}, remedy="name the file of a log"
        ) from error


def _result_file(named: str | None) -> Path | None:
    """Give the file of the earlier result that the options name; None where they name none."""
    if named is None:
        return None
    if not Path(named).is_file():
        raise OptionError(
            f"there is no result {named} to compare with",
            evidence={"reference": named},
            remedy='name the file of an earlier result document, or "prior"',
        )
    read_result(named)
    return Path(named)


def _note_compilation() -> None:
    if not share_compiled_kernels():
        note(f"the first computation on a machine compiles for {COMPILING}; afterwards it starts in seconds")

"""Compute in this process, on files: no service, no database, nothing kept."""

import hashlib
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from ....core.errors import LogError, OptionError, RobotError
from ...json_text import json_bytes
from ..kernel_cache import COMPILING, share_compiled_kernels
from ..output.files import save
from ..output.streams import note
from ..threads import limit_threads
from .protocol import WHOLE, Document, FromUrdf, Study, Tell, require_whole

PRIOR = "prior"


class LocalBench:
    """Do the work here."""

    def __init__(self) -> None:
        limit_threads(1)

    def robots(self) -> list[Document]:
        """List the built-in robots."""
        from ...services.catalogue import built_in_robots
        from ...services.serialisers import robot_summary

        return [robot_summary(robot) for robot in built_in_robots().values()]

    def robot(self, given: str, part: FromUrdf = WHOLE) -> Document:
        """Read a built-in robot, a description or a URDF.

        Raises
        ------
        RobotError
            If there is none, or it cannot be used.
        """
        from ...jobs import computations as science

        known = science.built_in_descriptions()
        if given in known:
            require_whole(given, part)
            model, description = science.read_description(known[given])
        else:
            content = _robot_file(given, known)
            if content.lstrip()[:1] in (b"{", b"[") or given.endswith(".json"):
                from ...http.body.json_body import parse_json

                require_whole(given, part)
                model, description = science.read_description(parse_json(content, what=given))
            else:
                model, description = science.read_urdf(content, **vars(part))
        return {
            "id": given,
            "name": model.name,
            "joints": len(model.joints),
            "built_in": given in known,
            "suspicions": list(science.doubts(model)),
            "description": description,
        }

    def base_parameters(self, given: str, part: FromUrdf = WHOLE) -> Document:
        """Say what motion of a robot can tell apart."""
        from ...jobs import computations as science

        description = self.robot(given, part)["description"]
        _tell_of_compiling()
        return {"robot": given} | science.base_parameters(description)

    def run(self, study: Study, tell: Tell, report: Path | None) -> bytes:
        """Compute; what cannot succeed is refused before the solver is loaded.

        Raises
        ------
        VeritorqueError
            If the robot, the logs or the options do not allow it.
        """
        from ...jobs import computations as science
        from ...jobs.computation import Computation, LogFile
        from ...services.catalogue import log_name
        from ...services.report import report_page

        tell("load", 0.0)
        robot = self.robot(study.robot, study.part)["description"]
        science.read_options(study.kind, dict(study.options))
        mapping = None if study.mapping is None else dict(study.mapping)
        logs = tuple(LogFile(path, log_name(path.name), mapping, _hash(path)) for path in study.logs)
        _tell_of_compiling()
        with _reference(study) as (options, reference), tempfile.TemporaryDirectory() as folder:
            traces = None if report is None else Path(folder) / "residuals.parquet"
            document = science.compute(
                Computation(study.kind, robot, logs, options, reference, traces=traces), tell
            )
            if report is not None:
                save(report, report_page(document, traces).encode())
            return json_bytes(document)


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
            f"{path} cannot be read",
            evidence={"reason": error.strerror},
            remedy="name the file of a log",
        ) from error


@contextmanager
def _reference(study: Study) -> Iterator[tuple[Document, Path | None]]:
    """Give the options, with the earlier result that they name in a file named by its hash."""
    options = dict(study.options)
    named = options.get("reference")
    if not isinstance(named, str) or named == PRIOR:
        yield options, None
        return
    if not Path(named).is_file():
        raise OptionError(
            f"there is no result {named} to compare with",
            evidence={"reference": named},
            remedy='name the file of an earlier result document, or "prior"',
        )
    with tempfile.TemporaryDirectory() as directory:
        kept = Path(directory) / _hash(Path(named))
        shutil.copyfile(named, kept)
        yield options, kept


def _tell_of_compiling() -> None:
    if not share_compiled_kernels():
        note(f"the first computation on a machine compiles for {COMPILING}; afterwards it starts in seconds")

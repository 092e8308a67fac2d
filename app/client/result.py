"""Read a result document as typed tables: arrays to compute with, data frames to show.

The document itself stays at hand and is what is stored and passed on; see docs/http.md for its fields.
"""

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from ...core.document.model.answer import model_name, plain_document
from ...core.errors import OptionError

if TYPE_CHECKING:
    import pandas as pd

Document = Mapping[str, Any]
Words = tuple[str, ...]
Floats = np.ndarray[tuple[int], np.dtype[np.float64]]
Counts = np.ndarray[tuple[int], np.dtype[np.int64]]
Flags = np.ndarray[tuple[int], np.dtype[np.bool_]]


@dataclass(frozen=True, eq=False)
class Rows:
    """Hold rows of a document as columns: names and words as tuples, numbers as arrays (NaN where absent)."""

    @classmethod
    def from_rows(cls, rows: Sequence[Document]) -> Self:
        """Read rows whose fields have the names of the columns."""
        return cls(**{column.name: _READERS[column.type](rows, column.name) for column in fields(cls)})

    def __len__(self) -> int:
        """Count the rows."""
        return len(getattr(self, fields(self)[0].name))

    def frame(self) -> "pd.DataFrame":
        """Give the rows as a data frame.

        Raises
        ------
        OptionError
            If pandas is not installed.
        """
        try:
            import pandas as pd
        except ImportError as error:
            raise OptionError(
                "data frames need pandas, which is not installed",
                evidence={"missing": "pandas"},
                remedy="pip install 'veritorque[notebook]', or use the arrays",
            ) from error
        return pd.DataFrame({column.name: getattr(self, column.name) for column in fields(self)})


@dataclass(frozen=True, eq=False)
class BaseParameters(Rows):
    """The combinations of parameters that the motion can distinguish, and how well each is known.

    Attributes
    ----------
    value, value_ols
        Of the physically consistent robot, and of least squares, in `unit`.
    standard_deviation
        In `unit`.
    relative_deviation_percent
        %P.
    essential
        Whether the motion needs it.
    grouping
        The standard parameters that it adds up.
    """

    name: Words
    joint: Counts
    unit: Words
    value: Floats
    value_ols: Floats
    standard_deviation: Floats
    relative_deviation_percent: Floats
    essential: Flags
    grouping: Words


@dataclass(frozen=True, eq=False)
class StandardParameters(Rows):
    """One robot of the many with the same base parameters: ten numbers per link, and the drives'.

    Attributes
    ----------
    identifiable
        ``individually``, ``in_combination`` or ``no``: only the first are measured by themselves.
    """

    name: Words
    joint: Counts
    unit: Words
    value: Floats
    identifiable: Words


@dataclass(frozen=True, eq=False)
class JointErrors(Rows):
    """Torque prediction error per joint; RMS in N m, for prismatic joints in N."""

    joint: Counts
    rms_torque: Floats
    rms_residual: Floats
    nrmse_of_range_percent: Floats
    nrmse_of_rms_percent: Floats


@dataclass(frozen=True)
class Finding:
    """Something that the simulation gets wrong; see docs/diagnosis.md.

    Attributes
    ----------
    parameters
        Value and standard deviation by name.
    ambiguous_with
        Causes that explain it as well.
    improvement_percent
        Reduction of the error on these joints on held-out motion; None where it was not measured.
    """

    cause: str
    joints: tuple[int, ...]
    statement: str
    confidence: float
    parameters: Mapping[str, tuple[float, float]]
    ambiguous_with: tuple[str, ...]
    improvement_percent: float | None

    @classmethod
    def from_document(cls, document: Document) -> Self:
        """Read one of the findings of a diagnosis."""
        gain = document.get("gain")
        return cls(
            cause=document["cause"],
            joints=tuple(document["joints"]),
            statement=document["statement"],
            confidence=document["confidence"],
            parameters={
                row["name"]: (row["value"], row["standard_deviation"]) for row in document["parameters"]
            },
            ambiguous_with=tuple(other["cause"] for other in document["ambiguous_with"]),
            improvement_percent=None if gain is None else gain["improvement_total_percent"],
        )


@dataclass(frozen=True, eq=False)
class Result:
    """Hold one result: the identified robot, and of a diagnosis its verdict and findings.

    Attributes
    ----------
    document
        The whole of it, as the service sent it.
    fit, validation
        Error of the predicted torque on the fitted motion, and on motion held out of the fit.
    verdict
        ``causes_found``, ``nothing_found`` or ``unexplained``; None of an identification.
    model
        Which model all numbers are of: ``extended`` after a diagnosis that found something, else ``plain``.
    """

    document: Document
    base: BaseParameters
    standard: StandardParameters
    fit: JointErrors
    validation: JointErrors
    verdict: str | None
    findings: tuple[Finding, ...]
    model: str

    @classmethod
    def from_document(cls, document: Document) -> Self:
        """Read a result document.

        Raises
        ------
        OptionError
            If it holds no identified robot.
        """
        if "base_parameters" not in document:
            raise OptionError(
                f"the document of a job of kind {document.get('kind')} holds no identified robot",
                evidence={"kind": document.get("kind")},
                remedy="read it as JSON: Client.result_bytes",
            )
        diagnosis = document.get("diagnosis") or {"verdict": None, "findings": ()}
        return cls(
            document=document,
            base=BaseParameters.from_rows(document["base_parameters"]),
            standard=StandardParameters.from_rows(document["standard_parameters"]),
            fit=JointErrors.from_rows(document["fit"]),
            validation=JointErrors.from_rows(document["validation"]),
            verdict=diagnosis["verdict"],
            findings=tuple(Finding.from_document(finding) for finding in diagnosis["findings"]),
            model=model_name(document),
        )

    @property
    def plain(self) -> Self:
        """Give the same result with the numbers of the plain model, the one before any correction."""
        return self.from_document(plain_document(self.document))

    @property
    def physically_consistent(self) -> bool:
        """Return whether every identified body is physically consistent."""
        return bool(min(self.document["feasibility"]["pseudo_inertia_min_eigenvalue"]) > 0.0)

    def save(self, path: Path | str) -> None:
        """Write the document, from which `Result.load`, reports and exports are made."""
        Path(path).write_text(json.dumps(self.document), encoding="utf-8")

    @classmethod
    def load(cls, path: Path | str) -> Self:
        """Read a document that was saved."""
        return cls.from_document(json.loads(Path(path).read_text(encoding="utf-8")))


def _words(rows: Sequence[Document], name: str) -> Words:
    return tuple(str(row.get(name) or "") for row in rows)


def _numbers(rows: Sequence[Document], name: str) -> Floats:
    values = [row.get(name) for row in rows]
    return np.array([np.nan if value is None else value for value in values], dtype=np.float64)


def _whole(rows: Sequence[Document], name: str) -> Counts:
    return np.array([row[name] for row in rows], dtype=np.int64)


def _flags(rows: Sequence[Document], name: str) -> Flags:
    return np.array([bool(row.get(name)) for row in rows])


_READERS: Mapping[Any, Callable[[Sequence[Document], str], Any]] = {
    Words: _words,
    Floats: _numbers,
    Counts: _whole,
    Flags: _flags,
}

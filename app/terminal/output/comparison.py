"""Print a comparison of estimators: errors and cost first, then the parameters."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from rich.console import Console
from rich.markup import escape

from .columns import Column, print_table
from .tables import number, reading_lines
from .warnings import print_warnings

Document = Mapping[str, Any]
MISSING = "-"
_ANSWER = {None: MISSING, True: "yes", False: "no"}


def print_comparison(console: Console, result: Document) -> None:
    """Print warnings, how the logs were read, a row per estimator, and the parameters by each."""
    print_warnings(console, result)
    for line in reading_lines(result):
        console.print(line)
    print_table(console, estimator_columns(result["compared"]), title="Estimators")
    for line in remarks(result["compared"]):
        console.print(escape(line))
    given = [row for row in result["compared"] if row["base_parameters"]]
    print_table(console, parameter_columns(given), title="Base parameters ± standard deviation")


def estimator_columns(rows: Sequence[Document]) -> list[Column]:
    """Give errors on held-out data, consistency, convergence and cost per estimator."""
    return [
        Column("estimator", [row["estimator"] for row in rows], is_text=True),
        Column("torque error, %", [_shown(row["validation_total_percent"]) for row in rows]),
        Column("motion error, %", [_shown(motion_percent(row["simulated_motion"])) for row in rows]),
        Column("consistent", [_ANSWER[row["feasible"]] for row in rows], is_text=True),
        Column("steps", [_steps(row["estimation"]) for row in rows]),
        Column("CPU, s", [number(row["cpu_seconds"], digits=2) for row in rows]),
    ]


def motion_percent(motion: Document | None) -> float | None:
    """Give the error of simulated motion at the longest horizon, as a share of keeping the velocity.

    Examples
    --------
    >>> motion_percent({"position_rms": [[0.1, 0.1], [0.3, 0.4]], "steady_rms": [[1.0, 1.0], [3.0, 4.0]]})
    10.0
    """
    if motion is None:
        return None
    shares = [
        error / steady
        for error, steady in zip(motion["position_rms"][-1], motion["steady_rms"][-1], strict=True)
        if steady
    ]
    if not shares:
        return None
    return float(100.0 * (sum(share**2 for share in shares) / len(shares)) ** 0.5)


def remarks(compared: Sequence[Document]) -> list[str]:
    """Say why estimators failed or could not be simulated, how they ended, and what instruments tell.

    What is said of several is said once.
    """
    said: dict[str, list[str]] = {}
    for row in compared:
        for sentence in _remarks(row):
            said.setdefault(sentence, []).append(row["estimator"])
    return [f"{', '.join(names)}: {sentence}" for sentence, names in said.items()]


def _remarks(row: Document) -> Iterator[str]:
    failure, ended = row["failure"], row["estimation"]
    if failure is not None:
        yield f"{failure['cause']}; {failure['remedy']}"
    if ended is not None:
        yield from ended["statements"][1:]  # the first sentence names the estimator
    if row["simulated_motion_note"]:
        yield f"motion was not simulated: {row['simulated_motion_note']}."


def parameter_columns(given: Sequence[Document]) -> list[Column]:
    """Give every base parameter by every estimator that gave one."""
    if not given:
        return []
    first = given[0]["base_parameters"]
    return [
        Column("parameter", [row["name"] for row in first], is_text=True),
        Column("unit", [row["unit"] for row in first], is_text=True),
        *(
            Column(one["estimator"], [_measured(row) for row in one["base_parameters"]], is_text=True)
            for one in given
        ),
    ]


def _measured(row: Document) -> str:
    deviation = row["standard_deviation"]
    known = "" if deviation is None else f" ± {number(deviation, digits=2)}"
    return f"{number(row['value'])}{known}"


def _shown(value: float | None) -> str:
    return MISSING if value is None else number(value, digits=3)


def _steps(ended: Document | None) -> str:
    return MISSING if ended is None else str(len(ended["steps"]) or 1)

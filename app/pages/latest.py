"""Write the latest jobs as rows of a table: what was asked for, how far it is, how old, and where to read on.

Names of robots and logs, and problems, hold what clients wrote: every text is escaped. What was deleted since
is named by its id and not linked.
"""

from datetime import UTC, datetime
from html import escape

from app.catalogue import Catalogue
from app.store.records import JobRecord

COLUMNS = ("Job", "Robot", "Logs", "State", "Asked for", "Outcome")
MOST_LOGS = 3
SHORT_ID = 12
"""Letters of an id that tell it from its neighbours; the whole one shows when pointed at."""


def job_rows(jobs: list[JobRecord], catalogue: Catalogue, *, now: datetime | None = None) -> str:
    """Write one row per job, or one which says that there is none."""
    if not jobs:
        return f'<tr><td colspan="{len(COLUMNS)}">None yet.</td></tr>'
    instant = now or datetime.now(UTC)
    return "".join(_row(job, catalogue, instant) for job in jobs)


def header_cells() -> str:
    """Write the names of the columns."""
    return "".join(f"<th>{name}</th>" for name in COLUMNS)


def lasting(seconds: float) -> str:
    """Say how long something lasts in its largest unit, rounded down.

    Examples
    --------
    >>> lasting(0.4), lasting(59.9), lasting(60.0), lasting(7300.0), lasting(200000.0)
    ('0 s', '59 s', '1 min', '2 h', '2 d')
    """
    for unit, length in (("d", 86400), ("h", 3600), ("min", 60)):
        if seconds >= length:
            return f"{int(seconds // length)} {unit}"
    return f"{int(max(seconds, 0.0))} s"


def _row(job: JobRecord, catalogue: Catalogue, now: datetime) -> str:
    cells = (
        f'<a href="/v1/jobs/{job.id}">{_short(job.id)}</a> {escape(job.request.kind)}',
        _robot(job, catalogue),
        _logs(job, catalogue),
        _state(job),
        _age(job, now),
        _outcome(job),
    )
    return "<tr>" + "".join(f"<td>{cell}</td>" for cell in cells) + "</tr>"


def _robot(job: JobRecord, catalogue: Catalogue) -> str:
    robot = catalogue.find_robot(job.request.robot)
    return _short(job.request.robot) if robot is None else _link(f"/v1/robots/{robot.id}", robot.name)


def _logs(job: JobRecord, catalogue: Catalogue) -> str:
    shown = []
    for identity in job.request.logs[:MOST_LOGS]:
        log = catalogue.find_log(identity)
        name = "" if log is None else str(log.summary["name"])
        shown.append(_short(identity) if log is None else _link(f"/v1/logs/{log.id}", name))
    more = len(job.request.logs) - len(shown)
    return ", ".join(shown) + (f" and {more} more" if more else "")


def _state(job: JobRecord) -> str:
    progress = f" {escape(job.stage)} {job.fraction:.0%}" if job.state == "running" else ""
    return f'<span class="state {job.state}">{job.state}</span>{progress}'


def _age(job: JobRecord, now: datetime) -> str:
    asked = datetime.fromisoformat(job.created_at)
    utc = asked.strftime("%Y-%m-%d %H:%M:%S UTC")
    age = lasting((now - asked).total_seconds())
    return f'<time datetime="{escape(job.created_at)}" title="{utc}">{age} ago</time>'


def _outcome(job: JobRecord) -> str:
    path = f"/v1/jobs/{job.id}"
    if job.state == "successful":
        forms = (("report", "report"), ("results", "result"), ("results/parameters.csv", "table"))
        return ", ".join(_link(f"{path}/{place}", word) for place, word in forms)
    if job.problem is not None:
        return _link(path, "problem") + ": " + escape(str(job.problem["cause"]))
    return ""


def _short(identity: str) -> str:
    if len(identity) <= SHORT_ID:
        return escape(identity)
    return f'<span title="{escape(identity)}">{escape(identity[:SHORT_ID])}&hellip;</span>'


def _link(path: str, text: str) -> str:
    return f'<a href="{escape(path)}">{escape(text)}</a>'

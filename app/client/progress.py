"""Show the progress of a job: a bar in a terminal or a notebook, plain lines elsewhere."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.markup import escape
from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeElapsedColumn

Report = Callable[[str, float], None]


@contextmanager
def bar(console: Console | None = None) -> Iterator[Report]:
    """Give the function that is called with the stage and the fraction that is done.

    Parameters
    ----------
    console
        Where to draw; standard error if None. Piped, every stage is one line.
    """
    console = console or Console(stderr=True)
    if not (console.is_terminal or console.is_jupyter):
        yield _lines(console)
        return
    columns = (TextColumn("{task.description:<18}"), BarColumn(), TaskProgressColumn(), TimeElapsedColumn())
    with Progress(*columns, console=console, transient=True) as progress:
        task = progress.add_task("start", total=1.0)
        yield lambda stage, done: progress.update(task, description=escape(stage), completed=done)


def _lines(console: Console) -> Report:
    last: list[str] = []

    def tell(stage: str, done: float) -> None:
        if last != [stage]:
            last[:] = [stage]
            console.print(f"{100.0 * done:3.0f} % {stage}", markup=False, highlight=False)

    return tell

"""Run a worker that computes jobs, on this machine or another one."""

from typing import Annotated

import typer

from ..computing import keep_compiled_kernels, limit_threads
from ..environment import open_store, read_settings, require_directory

COMMANDS = typer.Typer(add_completion=False, rich_markup_mode=None)


@COMMANDS.command(epilog="\b\nExample:\n  VERITORQUE_DATA_DIR=lab-data veritorque work")
def work(
    *,
    beside: Annotated[
        bool, typer.Option(hidden=True, help="Report liveness, and end with the service.")
    ] = False,
) -> None:
    """Compute jobs in this process, next to the service or on another machine.

    It needs the same VERITORQUE_DATABASE_URL and the same VERITORQUE_DATA_DIR as the service.
    """
    settings = read_settings()
    require_directory(settings.data_dir)
    limit_threads(settings.job_cpus)
    keep_compiled_kernels(settings.data_dir)
    from ...jobs.worker_process import work_until_stopped
    from ...logging import configure_logging

    configure_logging(settings)
    with open_store(settings) as store:
        work_until_stopped(store, settings, beside=beside)

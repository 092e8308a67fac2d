"""Be the service and its workers in every respect, but for what is computed: see `tests.chaos.work`.

The imports stand inside, because every process that computes a job loads this module again.
"""

import os
import subprocess
import sys


def main():
    """Run a command of the service."""
    from veritorque.app.jobs import supervisor
    from veritorque.app.services import workers
    from veritorque.app.terminal.main import main as command

    workers.executor_of = _executor  # before the command loads what takes it from there
    supervisor.start_worker = _start_worker
    command()


def _executor(settings, _store):
    from tests.chaos.work import compute
    from veritorque.app.jobs.executors.limits import Limits
    from veritorque.app.jobs.executors.process_executor import ProcessExecutor

    limits = Limits(settings.job_memory_bytes, settings.job_cpus)
    return ProcessExecutor(compute, limits=limits, preload=("tests.chaos.work",), at_once=settings.workers)


def _start_worker(settings):
    return subprocess.Popen(
        [sys.executable, "-m", "tests.chaos.service", "work", "--beside"],
        env={**os.environ, **settings.environment()},
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
    )


if __name__ == "__main__":
    main()

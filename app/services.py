"""Hold what every request needs, opened once at the start of the service and closed at its end."""

from dataclasses import dataclass
from typing import Annotated

from fastapi import Depends, Request

from app.catalogue import Catalogue
from app.jobs.executor import Executor
from app.jobs.queue import Queue
from app.jobs.runner import Runner
from app.settings import Settings
from app.store.store import Store


@dataclass(frozen=True)
class Services:
    """Carry the settings and the parts of the service that requests use."""

    settings: Settings
    store: Store
    catalogue: Catalogue
    runner: Runner
    queue: Queue

    @classmethod
    def open(cls, settings: Settings, executor: Executor) -> "Services":
        """Open the store and begin to work through the queue."""
        store = Store(settings.data_dir)
        catalogue = Catalogue(store)
        robots = {identity: robot.description for identity, robot in catalogue.built_in.items()}
        runner = Runner(
            store, executor, robots=robots, workers=settings.workers, timeout_s=settings.job_timeout_s
        )
        runner.start()
        return cls(settings, store, catalogue, runner, Queue(store, runner))

    def close(self) -> None:
        """Stop the computations, queue their jobs again, and close the store."""
        self.runner.close()
        self.store.close()


def _of_request(request: Request) -> Services:
    services: Services = request.app.state.services
    return services


ServicesOf = Annotated[Services, Depends(_of_request)]

"""Run computations away from the service: in comes a queued job, out goes a result or a problem."""

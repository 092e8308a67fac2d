"""Run computations away from the service: in comes a queued job, out goes a result document or the reason why there is none."""

"""Hold the tests of the service: in comes an app on a temporary directory, out go answers over HTTP."""

"""Name what a simulation gets wrong: in come logs and a model, out goes a `Diagnosis`.

`dataset` prepares the rows, `regression` fits columns under AR noise, `causes` holds one file per cause,
`search` selects causes stepwise, `checks` tests the result, `residual` describes what is left, and
`thresholds` holds every number that decides. `diagnose` is the algorithm on one page.
"""

"""Draw the report.

It is composed from a result document alone and uses nothing else of core, so that a service draws it from a
stored result without loading the science.
"""

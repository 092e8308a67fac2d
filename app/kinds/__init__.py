"""Define the kinds of job: in come a robot, logs and options, out go result documents.

One file per kind; everything else in `app` iterates over `registry.KINDS`.
"""

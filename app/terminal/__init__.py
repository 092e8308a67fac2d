"""Offer everything in a terminal: on files in this process, or on a service with `--url`.

In come arguments and files, out go tables for people, documents for programs and exit codes for scripts.
Every command is loaded when it is asked for.
"""

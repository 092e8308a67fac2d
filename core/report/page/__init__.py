"""Draw the page that people read.

In comes a result document as plain data, out goes one self-contained HTML file. Nothing else of core is used,
so that a service draws the page from a stored result without loading the science.
"""

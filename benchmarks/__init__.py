"""Measure speed and accuracy against other tools: in come a robot and a log, out go figures and targets.

Times are processor times on one thread; ratios are taken within one run, because machines are shared.
"""

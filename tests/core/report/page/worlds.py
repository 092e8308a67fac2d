"""Make traces as a service hands them to the page: thinned, with a gap, some of it held out."""

from math import cos, sin

from veritorque.core.report.page.traces import EXTENDED, FILTERED, MEASURED, MOTION, PLAIN, JointTraces

UNITS = {"position": "rad", "velocity": "rad/s"}


def traces(joints=7, *, log=1, extended=False):
    """Give traces of a robot of so many joints, 200 points each over 10 s."""
    return [_joint(log, joint, EXTENDED if extended else PLAIN) for joint in range(1, joints + 1)]


def _joint(log, joint, predicted):
    time = [0.05 * step for step in range(200)]
    swing = [joint * sin(0.7 * joint * stamp) for stamp in time]
    swing[100] = None
    signals = dict.fromkeys((MOTION[0], MEASURED, FILTERED, predicted[0]), swing)
    signals[MOTION[1]] = [0.7 * joint**2 * cos(0.7 * joint * stamp) for stamp in time]
    signals[predicted[1]] = [0.01 * sin(9.0 * stamp) for stamp in time]
    units = {name: UNITS.get(name, "N m") for name in signals}
    return JointTraces(log, joint, time, signals, units, [(2.0, 3.0), (7.0, 8.0)])

"""Stand for a solver that is still being compiled: whoever loads this waits."""

import time

time.sleep(300.0)

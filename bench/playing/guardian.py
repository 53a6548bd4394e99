"""Groups of processes, which end as a whole: a worker, and all that its planners have started.

A guardian in a session of its own is told of each group, and ends those that are left when the run is gone, however
that was ended. What a planner has put into a session of its own is out of reach.
"""

import os
import signal
import subprocess
import sys
from contextlib import suppress

GUARD = """
import os, signal, sys
groups = set()
for line in sys.stdin:
    groups ^= {int(line)}  # told as it begins, and again as it ends
for group in groups:
    for kill in (os.killpg, os.kill):
        try:
            kill(group, signal.SIGKILL)
        except OSError:
            pass
"""


class Guardian:
    """Ends groups that outlive the process which has made it."""

    def __init__(self) -> None:
        """Start it; it needs nothing but Python."""
        command = [sys.executable, "-I", "-S", "-c", GUARD]
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, start_new_session=True, text=True)  # noqa: S603  a fixed command

    def toggle(self, group: int) -> None:
        """Tell it that a group begins, or has ended."""
        assert self.process.stdin is not None
        with suppress(OSError):  # somebody has killed it
            self.process.stdin.write(f"{group}\n")
            self.process.stdin.flush()

    def dismiss(self) -> None:
        """Let it end what is left, and go."""
        with suppress(OSError):
            self.process.communicate()


def end_group(group: int) -> None:
    """Kill all processes of a group, if there is one."""
    with suppress(OSError):
        os.killpg(group, signal.SIGKILL)

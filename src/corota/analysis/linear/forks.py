"""A process is not forked while one of its threads orders a matrix.

A lock of the core serializes orderings. A child that is forked while it is held would wait for
a thread that it does not have.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import os
import threading


class Unforked:
    """Context in which forks of other threads wait until it ends."""

    def __init__(self) -> None:
        self._changed = threading.Condition(threading.Lock())
        self._inside = 0

    def __enter__(self) -> None:
        with self._changed:
            self._inside += 1

    def __exit__(self, *rest: object) -> None:
        with self._changed:
            self._inside -= 1
            self._changed.notify_all()

    def before(self) -> None:
        """Wait until no ordering runs, and block new ones."""
        self._changed.acquire()
        while self._inside:
            self._changed.wait()

    def after(self) -> None:
        """Continue in the parent."""
        self._changed.release()

    def after_in_child(self) -> None:
        """Reset: there are no other threads."""
        self._changed = threading.Condition(threading.Lock())
        self._inside = 0


unforked = Unforked()
if hasattr(os, "register_at_fork"):
    os.register_at_fork(
        before=unforked.before,
        after_in_parent=unforked.after,
        after_in_child=unforked.after_in_child,
    )

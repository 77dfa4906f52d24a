"""A queue of tasks for a separate thread, limited in bytes."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Callable

#: Time between two looks at the queue [s].
BEAT = 0.25
#: Time before the first look [s]: a smaller job is over sooner.
FIRST_REST = 0.05
#: Largest number of pending bytes.
MOST_WAITING = 64 << 20


class TaskQueue:
    """Tasks in their order. Before the start each one is executed at once.

    The thread takes them four times a second; those of a small job wait until its end, because two
    threads of Python do not run at once.

    Parameters
    ----------
    flush : callable
        Called after large tasks, before the thread sleeps; not at its end, where files are closed.

    Attributes
    ----------
    error : Exception or None
        The first one; the tasks after it are dropped.
    seconds : float
        Processor time of the thread.
    """

    def __init__(self, flush: Callable[[], None]) -> None:
        self.error: Exception | None = None
        self.seconds = 0.0
        self._flush = flush
        self._tasks: deque[tuple[Callable[[], None], int]] = deque()
        self._waiting = 0
        self._some, self._hurry = threading.Event(), threading.Event()
        self._free = threading.Condition()
        self._stop = False
        self._thread: threading.Thread | None = None

    def start(self) -> None:
        """Start the thread."""
        self._stop = False
        thread = threading.Thread(target=self._work, name="corota-files", daemon=True)
        try:
            thread.start()
        except RuntimeError:  # no room for its stack: tasks are executed at once
            return
        self._thread = thread

    def put(self, task: Callable[[], None], size: int = 200) -> None:
        """Add a task with the size of its data in bytes.

        Raises
        ------
        Exception
            Of a task before.
        """
        if self.error is not None:
            raise self.error
        if self._thread is None:
            task()
            return
        with self._free:
            while self._waiting > MOST_WAITING and self.error is None:
                self._hurry.set()
                self._free.wait(1.0)
            self._waiting += size
        self._tasks.append((task, size))
        self._some.set()

    def attempt(self, task: Callable[[], None]) -> None:
        """Execute a task at once, and keep its error."""
        try:
            task()
        except Exception as error:  # the first error is the one to report
            self.error = self.error or error

    def drain(self) -> None:
        """Execute all pending tasks, and end the thread."""
        if self._thread is None:
            return
        self._stop = True
        self._some.set()
        self._hurry.set()
        self._thread.join()
        self._thread = None
        while self._tasks:
            self._empty()

    def _work(self) -> None:
        rest = FIRST_REST
        while self._tasks or not self._stop:
            if not self._stop:
                self._hurry.wait(rest)
                self._some.wait()
            rest = BEAT
            self._hurry.clear()
            self._some.clear()
            self._empty()
            if self._tasks:
                self._some.set()

    def _empty(self) -> None:
        begin, done, large = time.thread_time(), 0, False
        late = time.perf_counter() + BEAT
        while self._tasks:
            task, size = self._tasks.popleft()
            if self.error is None:
                self.attempt(task)
            done += size
            large = large or size > 200
            # Frequent increments must not delay the files.
            if done > MOST_WAITING // 4 or time.perf_counter() > late:
                break
        if large and self.error is None and not self._stop:
            self.attempt(self._flush)
        with self._free:
            self._waiting -= done
            self._free.notify_all()
        self.seconds += time.thread_time() - begin

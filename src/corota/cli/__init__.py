"""The command line, ``corota COMMAND``; large modules are imported on demand."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import atexit
import contextlib
import errno
import gc
import os
import signal
import sys
from typing import TYPE_CHECKING, NoReturn

from corota.cli.parser import make_parser

if TYPE_CHECKING:
    from collections.abc import Sequence

    from corota.cli.terminal import Terminal

#: Set this variable to see the Python traceback of an error.
TRACEBACK = "COROTA_TRACEBACK"
#: Commands that call :func:`collect_garbage` themselves, once their job is read.
READING = ("resume", "run")


def main(argv: Sequence[str] | None = None) -> int:
    """Run one command.

    Parameters
    ----------
    argv : sequence of str, optional
        Arguments; those of the process by default.

    Returns
    -------
    int
        Exit code: 0 done, 2 input, 3 model, 4 not converged, 5 resource, 6 file,
        7 interrupted, 64 command line, 70 internal.
    """
    words = sys.argv[1:] if argv is None else argv
    try:
        args = make_parser(words).parse_args(words)
    except SystemExit as stop:
        return int(stop.code or 0)
    from corota.cli.terminal import Terminal

    terminal = Terminal(quiet=args.quiet, json=args.json)
    try:
        code = _run(args.command, args, terminal)
    except KeyboardInterrupt:
        terminal.error("interrupted")
        code = 7
    return terminal.close(code)


def program() -> NoReturn:
    """Run the command of this process and end it.

    Python takes longer to free a program's objects than to solve a small model, so it is left to
    the system. Functions registered with ``atexit`` run first. Where threads are left, or MPI has
    to be closed, the process ends in the ordinary way. There is no garbage to search for while
    modules are imported.
    """
    gc.disable()
    reading = sys.argv[1:2] and sys.argv[1] in READING
    if reading and signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, end_at_once)
    code = main()
    threads = sys.modules.get("threading")
    if {"mpi4py", "petsc4py"} & set(sys.modules) or (
        threads is not None and threads.active_count() > 1
    ):
        sys.exit(code)
    try:
        for stream in (sys.stdout, sys.stderr):
            if stream is not None:
                stream.flush()
    except (OSError, ValueError):  # closed, or a full disk: Python says so
        sys.exit(code)
    atexit._run_exitfuncs()
    os._exit(code)


def end_at_once(number: int, frame: object) -> NoReturn:
    """End the process on a signal before a job has results.

    An exception in its place is lost, or becomes another one, where a module is being imported.
    """
    with contextlib.suppress(OSError):
        os.write(2, b"corota: error: interrupted\n")
    os._exit(7)


def collect_garbage() -> None:
    """Let Python look for cycles again, but not among the objects so far."""
    if not gc.isenabled():
        gc.freeze()
        gc.enable()


def _run(command: str, args: object, terminal: Terminal) -> int:
    """Run a command; every error becomes a message and an exit code."""
    from importlib import import_module

    from corota.errors import NO_CORE, SHORT, CorotaError, is_shortage

    try:
        import corota._core as _core

        _core.require_memory(0.0, f"corota {command}")
        # At the end of a chain of imports, calls within NumPy's cross the end of a block of
        # Python's stack a thousand times, and each time the system has to map another one.
        import_module("numpy")
        run = import_module(f"corota.cli.{command.replace('-', '_')}").run
        if command not in READING:
            collect_garbage()
        return int(run(args, terminal))
    except CorotaError as error:
        _trace()
        terminal.error(str(error))
        return error.exit_code
    except ImportError as error:
        _trace()
        terminal.error(NO_CORE if error.name == "corota._core" else str(error))
        return 5
    except MemoryError:
        _trace()
        terminal.error(SHORT)
        return 5
    except OSError as error:
        _trace()
        if isinstance(error, BrokenPipeError) and error.filename is None:
            return 0
        name = f"{error.filename}: " if error.filename else ""
        terminal.error(f"{name}{error.strerror or error}")
        return 5 if error.errno == errno.ENOMEM else 6
    except BaseException as error:
        # A panic of the core is not an Exception.
        if not isinstance(error, Exception) and type(error).__name__ != "PanicException":
            raise
        _trace()
        if "can't start new thread" in str(error):
            terminal.error("the system cannot create more threads, or has no memory for them")
            return 5
        if is_shortage(error):
            terminal.error(SHORT)
            return 5
        frame = error.__traceback__
        while frame is not None and frame.tb_next is not None:
            frame = frame.tb_next
        code = frame.tb_frame.f_code if frame else None
        place = (
            f" at {os.path.basename(code.co_filename)}:{frame.tb_lineno}" if frame and code else ""
        )
        terminal.error(
            f"internal error: {type(error).__name__}: {error}{place}\n"
            f"    please report it with the input; {TRACEBACK}=1 shows more"
        )
        return 70


def _trace() -> None:
    if os.environ.get(TRACEBACK):
        import traceback

        traceback.print_exc(file=sys.stderr)

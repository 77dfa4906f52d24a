"""Corota: co-rotational planar finite elements.

Names are imported at first use, so that ``corota --version`` does not load the numerics.
"""

# SPDX-License-Identifier: BSD-3-Clause
from importlib import import_module
from typing import Any

with open(f"{__path__[0]}/__init__.pyi", encoding="utf-8") as _stub:
    _WORDS = [line.split() for line in _stub if line.startswith("from")]
#: Module of each name, in the order of the stub.
_HOMES = {words[3]: words[1] for words in _WORDS}
__all__ = sorted(_HOMES.keys() - {"__version__"})


def __getattr__(name: str) -> Any:
    home = _HOMES.get(name)
    if home is None:
        raise AttributeError(f"module 'corota' has no attribute {name!r}")
    try:
        own = home == __name__
        module = import_module(f"{home}.{name}" if own else home)
        value = module if own else getattr(module, name)
    except ModuleNotFoundError as error:
        if error.name != "corota._core":
            raise
        from corota.errors import NO_CORE

        raise ModuleNotFoundError(NO_CORE, name=error.name) from None
    except (MemoryError, SystemError) as error:
        from corota.errors import SHORT, ResourceError, is_shortage

        if not is_shortage(error):
            raise
        raise ResourceError(SHORT) from None
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})

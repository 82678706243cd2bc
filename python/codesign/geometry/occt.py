"""OpenCASCADE reports on C's stdout whatever it does; here it is made to keep silent."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from OCP.Message import Message


@contextmanager
def silent() -> Iterator[None]:
    """OpenCASCADE without its printers."""
    messenger = Message.DefaultMessenger_s()
    printers = list(messenger.Printers())
    for printer in printers:
        messenger.RemovePrinter(printer)
    try:
        yield
    finally:
        for printer in printers:
            messenger.AddPrinter(printer)

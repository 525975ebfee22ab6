"""Measurements of the window.

In: how much is measured.
Out: tables of figures; a window that is driven, for other measurements.
Imports: `app.cli.bench.table`, `app.cli.bench.start` and `app.cli.bench.idle`; every part that it
measures.
"""

from app.cli.bench.ui.driver import Driver, dragging, playing
from app.cli.bench.ui.measures import REACH, Extent, tables

__all__ = ["REACH", "Driver", "Extent", "dragging", "playing", "tables"]

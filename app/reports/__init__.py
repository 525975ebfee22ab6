"""How far an animation distorts its drawing, as numbers and pictures.

In: a document, and its motion.
Out: certificates, curves over time, and pictures of them.
Imports: `app.motion`, `app.storage`.
"""

from app.reports.certification import IntervalReport, Report, certify_clip
from app.reports.curve_picture import draw_curves
from app.reports.curves import (
    TIMES,
    Curves,
    broken_lines,
    measure_curves,
    relative_to_keys,
    worst_points,
    write_curves,
)
from app.reports.domain_preview import draw_preview

__all__ = [
    "TIMES",
    "Curves",
    "IntervalReport",
    "Report",
    "broken_lines",
    "certify_clip",
    "draw_curves",
    "draw_preview",
    "measure_curves",
    "relative_to_keys",
    "worst_points",
    "write_curves",
]

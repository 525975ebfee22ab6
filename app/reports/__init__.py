"""How far an animation distorts its drawing, as numbers and pictures; what to tell of a problem.

In: a document, and its motion; exceptions.
Out: certificates, curves over time, and pictures of them; texts.
Imports: `app.motion`, `app.storage`.
"""

from app.reports.certification import (
    IntervalReport as IntervalReport,
    Report as Report,
    Verdict as Verdict,
    certify_clip as certify_clip,
)
from app.reports.corrected_frames import CorrectedReport as CorrectedReport, Short as Short
from app.reports.curve_picture import draw_curves as draw_curves
from app.reports.curves import (
    TIMES as TIMES,
    CorrectedAt as CorrectedAt,
    Curves as Curves,
    broken_lines as broken_lines,
    measure_curves as measure_curves,
    relative_to_keys as relative_to_keys,
    worst_points as worst_points,
    write_curves as write_curves,
)
from app.reports.domain_preview import draw_preview as draw_preview
from app.reports.problem import (
    library_version as library_version,
    machine_in_words as machine_in_words,
    problem_report as problem_report,
    trace_in_words as trace_in_words,
    without_names as without_names,
)

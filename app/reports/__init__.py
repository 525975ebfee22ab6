"""Reports: the distortion of an animation as numbers and pictures, and program errors.

In: a document, and its motion; exceptions.
Out: certificates, curves over time, and pictures of them; texts.
Imports: `app.motion`, `app.storage`.
"""

from app.reports.certification import (
    Report as Report,
    SegmentReport as SegmentReport,
    Verdict as Verdict,
    certify_clip as certify_clip,
    certify_document as certify_document,
)
from app.reports.certification_json import format_certification_json as format_certification_json
from app.reports.certification_table import format_certification_table as format_certification_table
from app.reports.corrected_frames import CorrectedReport as CorrectedReport, Short as Short
from app.reports.curve_picture import draw_curves as draw_curves
from app.reports.curves import (
    TIMES as TIMES,
    CorrectedSample as CorrectedSample,
    Curves as Curves,
    divide_by_keys as divide_by_keys,
    measure_curves as measure_curves,
    split_at_keys as split_at_keys,
    worst_points as worst_points,
    write_curves as write_curves,
)
from app.reports.domain_preview import draw_preview as draw_preview
from app.reports.problem import (
    describe_machine as describe_machine,
    format_problem_report as format_problem_report,
    format_trace as format_trace,
    library_version as library_version,
    redact_names as redact_names,
)

"""`lissom certify`: the distortion of an animation."""

import argparse

from app.cli.console import print_line, print_notices
from app.cli.options import add_project, add_variant_option
from app.texts import _

EXITS = {"proven": 0, "measured": 3, "over": 1}  # by verdict

EPILOG = _(
    """\
The report of a single layer is a table. For a scene of several layers it begins with one verdict
and a line for each layer: its worst values, and where they are. --details adds the tables.

Keyframes are certified: k, sigma_a and sigma_b hold at every point of the shape, not only at
samples. For each segment between two keys, the table has the measured extremes of the in-betweens,
over time and space, beside those of the two keys. The line below has the proven values, which hold
at every moment and every point. The true extremes lie between the measured and the proven values
("error" in JSON). Frames that fold, or that cannot be proven not to fold, are listed.

Each segment has a verdict, and so has the whole. The limits are those of the keyframes; with
auto-pins or smooth tangents they are the layer's.
  proven    every moment is proven to be within the limits; exit status 0
  measured  in-betweens never fold, but the limits are measured only; exit status 3
  over      a moment exceeds the limits or may fold, or a keyframe is not certified; exit status 1
In-betweens are proven with their auto-pins. Frames in which tracks and springs move handles are
solved and proven one by one; halfway between two frames the drawing is measured. Handles that miss
the targets of their tracks are listed, with frames and pixels. Repeats are examined once. Of more
than a thousand frames only some are examined, at equal steps ("looked_at" and "left_out" in JSON).
The verdict is then at best "measured".
Values count as within the limits up to .002 (k) or .2 % (both sigmas) beyond. While a key is held,
only this key counts until the next one. Around holes, the metric variant meets its Equation (13) by
least squares only.

examples:
  lissom certify wave.lissom
  lissom certify scene.lissom --details
  lissom certify wave.lissom --variant nu --json
"""
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_project(parser)
    add_variant_option(parser)
    parser.add_argument(
        "--details", action="store_true", help=_("also print the tables of all layers of a scene")
    )
    parser.add_argument("--json", action="store_true", help=_("print JSON instead of a table"))


def run(arguments: argparse.Namespace) -> int:
    from app.document import motion_notices
    from app.reports import (
        Verdict,
        certify_document,
        format_certification_json,
        format_certification_table,
    )
    from app.storage import load_project

    document = load_project(arguments.project)
    print_notices(motion_notices(document))
    reports = certify_document(document, arguments.variant)
    if arguments.json:
        print_line(format_certification_json(reports))
    else:
        print_line(format_certification_table(reports, details=arguments.details))
    return EXITS[Verdict.worst(report.verdict for report in reports.values())]

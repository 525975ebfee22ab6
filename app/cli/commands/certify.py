"""`lissom certify`: the distortion of an animation."""

import argparse

from app.cli.console import print_line, print_notices
from app.cli.options import add_project, add_variant_option

EXITS = {"proven": 0, "measured": 3, "over": 1}  # by verdict

EPILOG = """\
Of a scene of several layers one verdict comes first, then a line for each layer with the worst
that it reaches, and where; --details has the tables that a drawing of one layer has at once.

Keyframes are certified: their k, sigma_a and sigma_b hold at every point of the shape, not only at
samples. For each interval between two keys the extremes of the in-betweens over time and space, as
measured, stand beside the two keys' own; below them what is proven of every moment and every point.
The true extremes lie between what is measured and what is proven ("error" in JSON). Frames that
fold, or that cannot be proven not to, are named.

Each interval, and the whole, has one verdict, about the keyframes' bounds, or the layer's where
handles stay or the motion passes through its keys:
  proven    every moment is proven to be within; exit status 0
  measured  in-betweens never fold, but that they are within is measured only; exit status 3
  over      some are not within, or may fold, or a keyframe is not certified; exit status 1
In-betweens are proven with the handles that stay between keys. Frames in which tracks and springs
move handles are solved and proven one by one; halfway between two frames the drawing is measured.
Handles that cannot reach their tracks are named, with frames and pixels. Repeats are looked at
once. Of more than a thousand frames some are looked at, at equal steps ("looked_at", "left_out" in
JSON): then the verdict is at best measured.
Proven and measured values count as within up to .002 (k) or .2 % (both sigmas) beyond. Where a key
is held, nothing but that key counts until the next one. Around holes the metric variant meets its
Equation (13) by least squares only.

examples:
  lissom certify wave.lissom
  lissom certify scene.lissom --details
  lissom certify wave.lissom --variant nu --json
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_project(parser)
    add_variant_option(parser)
    parser.add_argument(
        "--details", action="store_true", help="print the tables of all layers of a scene, too"
    )
    parser.add_argument("--json", action="store_true", help="print JSON instead of a table")


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

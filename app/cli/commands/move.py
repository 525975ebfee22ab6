"""`lissom move`: picture + motion preset → project."""

import argparse
from dataclasses import fields, replace
from typing import TYPE_CHECKING

from app.cli.console import StatusLine, print_line, print_notices
from app.cli.options import (
    add_cut_out_options,
    add_meshing_options,
    input_file,
    output_file,
)
from app.errors import LissomError
from app.texts import _

if TYPE_CHECKING:
    from app.document import Document
    from app.solving import JointsFile, MotionRequest
    from engine.arrays import Bytes

EPILOG = _(
    """\
A motion preset moves the joints of a drawing. The command guesses the kind of body and the joints,
and prints them. A file of joints sets them instead:

  {"schema": 1, "kind": "biped-side",
   "joints": {"hips": [225, 250], "chest": [230, 365], "head": [235, 490],
              "knee.L": [300, 160], "foot.L": [330, 55], "knee.R": [190, 150],
              "foot.R": [125, 55]}}

Places are pixels of the drawing from its lower left corner, x to the right and y up, as in
`lissom pose`. These are the kinds and their joints; leave out joints that the drawing lacks:

  biped-front, biped-side, four-legs
    hips, chest, neck, head, tail, and on each side, as in knee.L and knee.R,
    shoulder, elbow, hand, hip, knee, foot; the hands of four legs are its front feet, and in a
    side view L and R are the two limbs of a pair, in any order; a long tail has tail.1 to tail.4
    between hips and tail
  chain
    joint.1, joint.2 and so on to joint.16, from the end that leads, or is held, to the other end
  anything
    none: it moves as a whole

The project has a handle at each joint, bones along the limbs, and at most 8 keys in a cycle, which
you can edit as any other keys. It loops, unless the motion travels. If the limits of distortion
stop joints short of their targets, a notice lists them, with the largest --size at which none is
stopped. The layers of a drawing are merged into one picture first.

examples:
  lissom move --list
  lissom move horse.png --motion walk --out horse.lissom
  lissom move person.png --motion wave --mirrored --size 0.8 --out hello.lissom
  lissom move bird.png --motion walk --joints bird.json --travel --out bird.lissom
"""
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "picture", metavar="DRAWING", type=input_file, nargs="?", help=_("the drawing")
    )
    parser.add_argument(
        "--list",
        action="store_true",
        help=_("list the motion presets, with the kinds of body that they fit"),
    )
    parser.add_argument("--motion", metavar="NAME", help=_("the motion preset to apply"))
    parser.add_argument(
        "--out", metavar="PROJECT.lissom", type=output_file, help=_("the file to write")
    )
    parser.add_argument("--kind", metavar="KIND", help=_("the kind of body"))
    parser.add_argument(
        "--joints", metavar="JOINTS.json", type=input_file, help=_("the joints of the drawing")
    )
    parser.add_argument(
        "--facing",
        choices=("left", "right"),
        help=_("the side that the drawing faces (default: guessed)"),
    )
    parser.add_argument(
        "--speed",
        metavar="X",
        type=float,
        default=1.0,
        help=_("speed of the motion, 0.1 to 4 (1 is usual)"),
    )
    parser.add_argument(
        "--size",
        metavar="X",
        type=float,
        default=1.0,
        help=_("size of swings and steps, 0.05 to 2 (1 is usual)"),
    )
    parser.add_argument(
        "--energy",
        metavar="X",
        type=float,
        default=1.0,
        help=_("amount of bounce and sway of the body, 0 to 2 (1 is usual)"),
    )
    parser.add_argument(
        "--mirrored", action="store_true", help=_("let the other side begin, or move alone")
    )
    parser.add_argument(
        "--start",
        metavar="X",
        type=float,
        default=0.0,
        help=_("where in its cycle the motion starts, from 0 to below 1"),
    )
    parser.add_argument(
        "--travel",
        action="store_true",
        help=_(
            "advance by one stride, with feet planted in the picture; the motion then does not loop"
        ),
    )
    parser.add_argument(
        "--lean",
        metavar="X",
        type=float,
        default=0.0,
        help=_("degrees by which the trunk leans forwards, -30 to 30"),
    )
    parser.add_argument(
        "--head-delay",
        metavar="X",
        type=float,
        default=0.0,
        help=_("share of the cycle by which the head is later, 0 to 0.5"),
    )
    parser.add_argument(
        "--arm-delay",
        metavar="X",
        type=float,
        default=0.0,
        help=_("share of the cycle by which the arms are later, 0 to 0.5"),
    )
    parser.add_argument(
        "--tail-delay",
        metavar="X",
        type=float,
        default=0.0,
        help=_("share of the cycle by which the tail is later, 0 to 0.5"),
    )
    add_meshing_options(parser)
    add_cut_out_options(parser)


def run(arguments: argparse.Namespace) -> int:
    """Apply a motion preset to a drawing and write the project, or list the presets."""
    if arguments.list:
        _list_motions()
        return 0
    from app.cli.drawings import open_drawing, save_drawing
    from app.rigging import Parameters, find_motion
    from app.solving import MotionRequest, find_joints
    from app.storage import check_writable

    for name, option in (("picture", "DRAWING"), ("motion", "--motion"), ("out", "--out")):
        if getattr(arguments, name) is None:
            text = _("{option} is missing (see 'lissom move --help')")
            raise LissomError(text.format(option=option))
    read = arguments.picture, arguments.joints, arguments.mask
    check_writable(arguments.out, sources=filter(None, read))
    motion = find_motion(arguments.motion)
    names = [field.name for field in fields(Parameters)]
    parameters = Parameters(**{name: getattr(arguments, name) for name in names})
    given = _read_joints(arguments)
    opened = open_drawing(arguments, merges_layers=True)
    layer = opened.document.layers[0]
    found = find_joints(layer, motion, given, opened.pictures[layer.id].rgba)
    if given.kind is None:
        print_line(_("kind: {kind} (guessed)").format(kind=found.kind))
    if found.joints and not given.joints:
        print_line(_("joints: {names} (guessed)").format(names=", ".join(found.joints)))
    request = MotionRequest(
        motion=arguments.motion,
        kind=found.kind,
        joints=found.joints,
        parameters=parameters,
        facing={"left": -1, "right": 1, None: None}[arguments.facing],
    )
    document = _solve(opened.document, request, opened.pictures[layer.id].rgba)
    save_drawing(arguments.out, opened, document)
    length = document.frames.last - document.frames.first
    summary = (
        _("{path}: {motion}, {frames} frames, looped, {keys} keys")
        if document.loop
        else _("{path}: {motion}, {frames} frames, {keys} keys")
    )
    print_line(
        summary.format(
            path=arguments.out,
            motion=arguments.motion,
            frames=length if document.loop else length + 1,
            keys=len(document.layers[0].keys),
        )
    )
    return 0


def _list_motions() -> None:
    from app.rigging import MOTIONS

    longest = max(map(len, MOTIONS))
    for name, motion in MOTIONS.items():
        text = _("{kinds}: {hint}; it may travel") if motion.can_travel else _("{kinds}: {hint}")
        text = text.format(kinds=", ".join(motion.kinds), hint=_(motion.hint))
        print_line(f"{name:<{longest}}  {text}")


def _read_joints(arguments: argparse.Namespace) -> "JointsFile":
    """Return the given kind and joints of the drawing."""
    from app.rigging import find_kind
    from app.solving import JointsFile, load_joints

    given = JointsFile(kind=None, joints={})
    if arguments.joints is not None:
        given = load_joints(arguments.joints)
    if arguments.kind is None:
        return given
    find_kind(arguments.kind)
    if given.kind not in (None, arguments.kind):
        text = _("--kind is {kind!r}, but {path} is for {other!r}; leave --kind out")
        raise LissomError(text.format(kind=arguments.kind, path=arguments.joints, other=given.kind))
    return replace(given, kind=arguments.kind)


def _solve(document: "Document", request: "MotionRequest", rgba: "Bytes") -> "Document":
    """Return the document with the motion; print notices about unreachable targets."""
    from app.solving import find_facing, start_motion_solve, step_motion_solve

    (layer,) = document.layers
    with StatusLine() as status:
        solve = start_motion_solve(document, layer.id, request, rgba)
        if request.facing is None and request.kind in {"biped-side", "four-legs"}:
            is_left = find_facing(layer, request) < 0
            print_line(_("facing: left (guessed)") if is_left else _("facing: right (guessed)"))
        while not solve.is_over:
            status.show(solve.status_text)
            solve = step_motion_solve(solve)
    print_notices(solve.notices)
    return solve.command(document)

"""`lissom move`: picture + motion preset → project."""

import argparse
from typing import NamedTuple

from app.cli.console import StatusLine, print_line, print_notices
from app.cli.cut_out import parse_cut_out
from app.document import Document, Layer, Meshing
from app.errors import LissomError
from app.rigging import (
    MOTIONS,
    Motion,
    Parameters,
    find_kind,
    find_motion,
    guess_kind,
    suggest_joints,
)
from app.solving import (
    JointsFile,
    MotionRequest,
    find_facing,
    load_joints,
    start_motion_solve,
    step_motion_solve,
)
from app.storage import (
    OpenedScene,
    check_writable,
    cut_picture,
    draw_thumbnail,
    is_layered,
    open_merged,
    open_picture,
    save_project,
)

WHOLE = "anything"  # motions of the whole drawing suit any kind
NO_JOINTS = JointsFile(kind=None, joints={})


class _LayerJoints(NamedTuple):
    kind: str
    joints: dict[str, complex]


def run(arguments: argparse.Namespace) -> int:
    """Apply a motion preset to a drawing and write the project, or list the presets."""
    if arguments.list:
        _list_motions()
        return 0
    for name, option in (("picture", "DRAWING"), ("motion", "--motion"), ("out", "--out")):
        if getattr(arguments, name) is None:
            raise LissomError(f"{option} is missing; 'lissom move --help' tells what is said")
    read = arguments.picture, arguments.joints, arguments.mask
    check_writable(arguments.out, sources=filter(None, read))
    motion, parameters = find_motion(arguments.motion), _parameters(arguments)
    told = NO_JOINTS if arguments.joints is None else load_joints(arguments.joints)
    if arguments.kind is not None:
        find_kind(arguments.kind)
        if told.kind not in (None, arguments.kind):
            raise LissomError(
                f"--kind is {arguments.kind!r}, but {arguments.joints} is of {told.kind!r}"
            )
    opened = _open_picture(arguments)
    layer = opened.document.layers[0]
    found = _find_joints(layer, motion, arguments.kind or told.kind, told)
    order = MotionRequest(
        motion=arguments.motion,
        kind=found.kind,
        joints=found.joints,
        parameters=parameters,
        facing={"left": -1, "right": 1, None: None}[arguments.facing],
        bones=arguments.bones,
    )
    document = _apply_motion(opened.document, order)
    _save(arguments, opened, document)
    return 0


def _list_motions() -> None:
    longest = max(map(len, MOTIONS))
    for name, motion in MOTIONS.items():
        travels = "; it may travel" if motion.can_travel else ""
        print_line(f"{name:<{longest}}  {', '.join(motion.kinds)}: {motion.hint}{travels}")


def _parameters(arguments: argparse.Namespace) -> Parameters:
    """Return the motion's parameters; refuse wrong ones before anything is read."""
    return Parameters(
        speed=arguments.speed,
        size=arguments.size,
        energy=arguments.energy,
        mirrored=arguments.mirrored,
        start=arguments.start,
        travel=arguments.travel,
    )


def _open_picture(arguments: argparse.Namespace) -> OpenedScene:
    """Return the drawing as a scene of one layer."""
    meshing = Meshing(triangles=arguments.triangles, detail=arguments.detail)
    open_one = open_merged if is_layered(arguments.picture) else open_picture
    opened = open_one(arguments.picture, meshing, parse_cut_out(arguments))
    print_notices((*opened.notices, *opened.document.import_log.lines))
    return opened


def _find_joints(layer: Layer, motion: Motion, kind: str | None, told: JointsFile) -> _LayerJoints:
    """Return the kind and the joints of a drawing, guessed if not given."""
    loops = layer.domain.loops
    if kind is None:
        if told.joints:
            raise LissomError("the file of joints does not say of which kind; add kind, or --kind")
        kind = guess_kind(loops).name
        if kind not in motion.kinds and WHOLE in motion.kinds:
            kind = WHOLE
        print_line(f"kind: {kind} (guessed)")
    joints = dict(told.joints)
    if not joints and find_kind(kind).parents:
        joints = dict(suggest_joints(loops, find_kind(kind)))
        if not joints:
            raise LissomError(f"no joints of {kind!r} are found in the drawing; tell --joints")
        print_line(f"joints: {', '.join(joints)} (guessed)")
    return _LayerJoints(kind, joints)


def _apply_motion(document: Document, order: MotionRequest) -> Document:
    """Return the document with the motion; print notices about unreachable targets."""
    with StatusLine() as status:
        giving = start_motion_solve(document, document.layers[0].id, order)
        if order.facing is None and order.kind in {"biped-side", "four-legs"}:
            side = "right" if find_facing(document.layers[0], order) > 0 else "left"
            print_line(f"it looks to the {side} (guessed)")
        while not giving.is_over:
            status.show(giving.status_text)
            giving = step_motion_solve(giving)
    print_notices(giving.notices)
    return giving.command(document)


def _save(arguments: argparse.Namespace, opened: OpenedScene, document: Document) -> None:
    """Write the project, and print a summary."""
    (layer,) = document.layers
    texture = cut_picture(opened.pictures[layer.id], layer.cut_out).texture
    save_project(arguments.out, document, thumbnail=draw_thumbnail(texture))
    length = document.frames.last - document.frames.first
    frames = f"{length} frames, looped" if document.loop else f"{length + 1} frames"
    print_line(f"{arguments.out}: {arguments.motion}, {frames}, {len(layer.keys)} keys")

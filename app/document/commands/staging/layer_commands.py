"""Commands on the figures as layers: which there are, in what order, seen when, hung on what."""

from collections.abc import Collection, Sequence
from dataclasses import replace

import numpy as np

from app.document.commands.command import command, figure_command, numbered
from app.document.commands.handle_commands import with_handles
from app.document.commands.key_commands import exchange
from app.document.commands.staging import choice_commands
from app.document.commands.staging.showing import revealed
from app.document.figure import Figure
from app.document.keyframe import Pose, Target
from app.document.layering import Attachment, BlendMode, Switch, paths_to, shared_path
from app.document.model import Document
from app.errors import ImportSummary, LissomError

LAST_LAYER = "A document has at least one layer; add another one first."


@command("Add layer")
def add_figure(document: Document, figure: Figure, index: int | None = None) -> Document:
    """Add a figure in front of all others, or at an index in the order from back to front.

    Its id must be a free one, as `free_identity` gives it; its name is numbered where it is taken.
    """
    figures = list(document.figures)
    place = len(figures) if index is None else index
    group, name = group_at(figures, place, figure), free_name(document, figure.name)
    figures.insert(place, replace(figure, name=name, group=group))
    # A canvas that was one picture's stays what it was.
    return replace(document, figures=tuple(figures), size=document.canvas)


@command("Add layers")
def keep_told(document: Document, summary: ImportSummary) -> Document:
    """Keep what was told when layers were brought in, after what was told before."""
    return replace(document, told=document.told + summary) if summary else document


@command("Replace layer")
def replace_figure(document: Document, identity: int, figure: Figure) -> Document:
    """Put another figure with the same id in a figure's place.

    What hangs on it does so as before, or at the nearest points where it is not there any more.
    """
    size = document.canvas
    changed = keep_joints(identity)(document.with_figure(replace(figure, id=identity)))
    return changed if changed.canvas == size else replace(changed, size=size)


@command("Keep joints")
def keep_joints(document: Document, identity: int) -> Document:
    """Move joints that are beside a figure now to the nearest points of it."""
    domain = document.figure(identity).domain
    for child in document.figures:
        places = np.array([joint.at for joint in child.joints], dtype=np.complex128)
        nearest = domain.nearest(places) if len(places) else places
        joints = tuple(
            replace(joint, at=complex(at)) if joint.to == identity and at != joint.at else joint
            for joint, at in zip(child.joints, nearest, strict=True)
        )
        if joints != child.joints:
            document = document.with_figure(replace(child, joints=joints))
    return document


@command("Duplicate layer")
def duplicate_figure(document: Document, identity: int) -> Document:
    """Put a copy of a figure in front of it, which takes turns with it where it takes turns."""
    figure = document.figure(identity)
    index = document.figures.index(figure)
    copy = replace(
        figure, id=free_identity(document), name=free_name(document, f"{figure.name} copy")
    )
    figures = (*document.figures[: index + 1], copy, *document.figures[index + 1 :])
    choices = tuple(
        replace(choice, figures=(*choice.figures, copy.id))
        if identity in choice.figures
        else choice
        for choice in document.choices
    )
    return replace(document, figures=figures, choices=choices, size=document.canvas)


@command("Delete layer")
def remove_figure(document: Document, identity: int) -> Document:
    """Remove a figure. What hung on it hangs as it did before that, else on nothing."""
    document.figure(identity)
    if len(document.figures) == 1:
        raise LissomError(LAST_LAYER)
    document = choice_commands.let_go(document, identity)
    figures = tuple(
        _without_ties(each, identity) for each in document.figures if each.id != identity
    )
    return without_empty_groups(replace(document, figures=figures, size=document.canvas))


@command("Move layer")
def move_figure(document: Document, identity: int, index: int) -> Document:
    """Put a figure at an index in the order from back to front.

    It stays in its groups as long as it lies beside others of them, and joins those amid which it
    comes to lie.
    """
    figure = document.figure(identity)
    others = [other for other in document.figures if other is not figure]
    if not 0 <= index <= len(others):
        raise LissomError(f"There are {len(others) + 1} layers; none can be number {index + 1}.")
    if document.figures[index] is figure:
        return document
    group = group_at(others, index, figure)
    others.insert(index, figure if group == figure.group else replace(figure, group=group))
    moved = replace(document, figures=tuple(others), size=document.canvas)
    return without_empty_groups(moved)


@command("Rename layer")
def rename_figure(document: Document, identity: int, name: str) -> Document:
    """Give a figure another name, which no other one may have."""
    return _with(document, identity, name=name.strip())


@command("Set opacity")
def set_opacity(document: Document, identity: int, opacity: float) -> Document:
    """Set how opaque a figure is painted."""
    return _with(document, identity, opacity=float(opacity))


@command("Set blend")
def set_blend(document: Document, identity: int, blend: BlendMode) -> Document:
    """Set how the colours of a figure meet those behind it."""
    return _with(document, identity, blend=blend)


@command("Clip layer")
def set_clipped(document: Document, identity: int, *, clipped: bool) -> Document:
    """Let a figure be seen only where what lies below it in its group is, or everywhere again."""
    return _with(document, identity, clipped=clipped)


@command("Show or hide layer")
def set_hidden(document: Document, identity: int, *, hidden: bool) -> Document:
    """Hide a figure at all times, or show it again."""
    return _with(document, identity, hidden=hidden)


@command("Show layer")
def reveal(document: Document, identity: int) -> Document:
    """Show a figure in whatever groups, and of those that were hidden nothing else."""
    return revealed(document, identity)


@command("Lock or unlock layer")
def set_locked(document: Document, identity: int, *, locked: bool) -> Document:
    """Let clicks on the drawing pass through a figure, or stop at it again."""
    return _with(document, identity, locked=locked)


@command("Set reference")
def set_reference(document: Document, identity: int, *, reference: bool) -> Document:
    """Leave a figure out of exports, or take it in again."""
    return _with(document, identity, reference=reference)


@command("Show or hide from here on")
def switch_at(document: Document, identity: int, frame: int, *, visible: bool | None) -> Document:
    """Show or hide a figure from a frame on; None takes back what was said at that frame.

    One that was hidden at all times is shown there, and hidden until then.
    """
    figure = document.figure(identity)
    switches = figure.switches
    if visible and (figure.hidden or document.is_in_hidden(figure)):
        document = revealed(document, identity)
        figure = document.figure(identity)
        switches = switches or (Switch(0, visible=False),)
    others = [switch for switch in switches if switch.frame != frame]
    if visible is not None:
        if not others and not switches and frame > 0:
            # What was seen before stays so.
            others = [Switch(0, not visible)]
        others.append(Switch(frame, visible))
    switches = tuple(sorted(others, key=lambda switch: switch.frame))
    return _with(document, identity, switches=switches)


@figure_command("Move visibility")
def move_switch(figure: Figure, frame: int, to: int) -> Figure:
    """Move the frame at which a figure is shown or hidden."""
    moved = [switch for switch in figure.switches if switch.frame == frame]
    if not moved:
        raise LissomError(f"{figure.name!r} is neither shown nor hidden at frame {frame}.")
    if to == frame:
        return figure
    others = [switch for switch in figure.switches if switch.frame != frame]
    switches = sorted([*others, replace(moved[0], frame=to)], key=lambda switch: switch.frame)
    return replace(figure, switches=tuple(switches))


@command("Attach")
def attach(document: Document, identity: int, anchor: complex, joint: Attachment) -> Document:
    """Hang a figure by its anchor on a point of another one from a frame on; circles are refused.

    What began to hold at that frame does no longer. `app.motion` finds the point and the turn with
    which nothing moves at a frame.
    """
    joints = [each for each in document.figure(identity).joints if each.frame != joint.frame]
    joints = sorted([*joints, joint], key=lambda each: each.frame)
    return _with(document, identity, anchor=anchor, joints=tuple(joints))


@figure_command("Attach as before")
def unjoin(figure: Figure, frame: int) -> Figure:
    """Take back what a figure hangs on from a frame on: what held before it still does."""
    joints = tuple(joint for joint in figure.joints if joint.frame != frame)
    return figure if joints == figure.joints else replace(figure, joints=joints)


@figure_command("Move joint in time")
def move_joint(figure: Figure, frame: int, to: int) -> Figure:
    """Let what a figure hangs on from a frame on hold from another frame on."""
    moved = next((joint for joint in figure.joints if joint.frame == frame), None)
    if moved is None:
        raise LissomError(f"{figure.name!r} is not attached anew at frame {frame}.")
    if to == frame:
        return figure
    others = [joint for joint in figure.joints if joint is not moved]
    joints = sorted([*others, replace(moved, frame=to)], key=lambda joint: joint.frame)
    return replace(figure, joints=tuple(joints))


@command("Detach")
def detach(document: Document, identity: int, factor: complex, shift: complex) -> Document:
    """Let a figure hang on nothing at any time, turned and moved as it was seen at one moment.

    Parameters
    ----------
    identity : int
    factor : complex
        Of modulus 1: by which all poses are turned.
    shift : complex
        By which they are moved then.
    """
    figure = document.figure(identity)
    if not figure.joints:
        return document
    poses = (_carried(figure, pose, factor, shift) for pose in figure.poses)
    return document.with_figure(figure.with_poses(poses, joints=()))


@figure_command("Set depth")
def set_front(figure: Figure, identity: int, front: float, extent: float | None) -> Figure:
    """Set what is in front around a handle, where no key says otherwise, and how far around it."""
    return with_handles(figure, {identity}, front=float(front), extent=extent)


@figure_command("Set depth from here on")
def key_front(figure: Figure, frame: int, identity: int, front: float | None) -> Figure:
    """Set what is in front around a handle from a key on; None says nothing at that key."""
    key = figure.key(frame)
    handle = figure.handle(identity)
    fronts = {i: depth for i, depth in key.fronts.items() if i != handle.id}
    if front is not None:
        fronts[handle.id] = float(front)
    if fronts == key.fronts:
        return figure
    return exchange(figure, {frame: replace(key, fronts=fronts)})


def free_identity(document: Document) -> int:
    """Return an id that no figure has."""
    return 1 + max(figure.id for figure in document.figures)


def free_name(document: Document, name: str) -> str:
    """Return a name for a figure that no other one has: this one, or this one with a number."""
    return numbered_name(name, {figure.name for figure in document.figures})


def numbered_name(name: str, taken: Collection[str]) -> str:
    """Return a name that is not taken: this one, or this one with a number."""
    return numbered(name, taken, 2) if name in taken else name


def without_empty_groups(document: Document) -> Document:
    """Return the document without groups that no figure is in any more."""
    filled = {path for figure in document.figures for path in paths_to(figure.group)}
    groups = tuple(group for group in document.groups if group.name in filled)
    return document if groups == document.groups else replace(document, groups=groups)


def group_at(others: Sequence[Figure], index: int, figure: Figure) -> str:
    """Return the group that a figure is in which is put at an index among others."""
    own, beside = figure.group, [each.group for each in others[max(index - 1, 0) : index + 1]]
    amid = shared_path(*beside) if len(beside) == 2 else ""
    if amid and amid not in paths_to(own):
        return amid
    stays = max((shared_path(own, group) for group in beside), key=len, default="")
    shared = max((shared_path(own, each.group) for each in others), key=len, default="")
    # With all of what else is in its groups elsewhere, it leaves them; alone in one, it keeps it.
    return own if stays == shared else stays


def _without_ties(figure: Figure, other: int) -> Figure:
    """Return a figure that neither hangs on another one at any time nor is painted beside it."""
    joints = tuple(joint for joint in figure.joints if joint.to != other)
    placings = tuple(placing for placing in figure.placings if placing.beside != other)
    if (joints, placings) == (figure.joints, figure.placings):
        return figure
    return replace(figure, joints=joints, placings=placings)


def _with(document: Document, identity: int, **changes: object) -> Document:
    figure = document.figure(identity)
    if all(getattr(figure, name) == value for name, value in changes.items()):
        return document
    return document.with_figure(replace(figure, **changes))  # type: ignore[arg-type]


def _carried(figure: Figure, pose: Pose, factor: complex, shift: complex) -> Pose:
    moved = figure.map_of(pose).moved(factor, shift)
    turn = float(np.angle(factor))
    targets = {
        identity: Target(
            position=factor * target.position + shift,
            rotation=None if target.rotation is None else target.rotation + turn,
            unknown=target.unknown,
        )
        for identity, target in pose.targets.items()
    }
    return replace(pose.with_map(moved), targets=targets)

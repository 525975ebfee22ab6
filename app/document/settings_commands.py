"""Commands on what surrounds the keys: timing, solver, export, and the domain itself."""

from collections.abc import Sequence
from dataclasses import replace

from app.document.commands import command
from app.document.keyframe import Keyframe, Pose
from app.document.model import Document
from app.document.settings import ExportSettings, FrameRange, Meshing, Variant
from app.errors import LissomError
from engine.domain import Domain
from engine.maps import Bounds


@command("Set frames per second")
def set_fps(document: Document, fps: float) -> Document:
    """Set how fast the animation plays."""
    return document if fps == document.fps else replace(document, fps=float(fps))


@command("Set frames")
def set_frames(document: Document, frames: FrameRange) -> Document:
    """Set the first and last frame; keys may not be left outside. The work range is cut to them."""
    if frames == document.frames:
        return document
    outside = next((key.frame for key in document.keys if key.frame not in frames), None)
    if outside is not None:
        raise LissomError(
            f"The key at frame {outside} would lie outside frames {frames.first} to {frames.last}; "
            "move or delete it first, or set a work range instead."
        )
    work = document.work
    if work is not None:
        apart = work.last < frames.first or work.first > frames.last
        cut = FrameRange(frames.clamp(work.first), frames.clamp(work.last))
        work = None if apart else cut
    return replace(document, frames=frames, work=work)


@command("Set work range")
def set_work_range(document: Document, work: FrameRange | None) -> Document:
    """Set the part of the frames that plays, or None for all of them."""
    return document if work == document.work else replace(document, work=work)


@command("Set loop")
def set_loop(document: Document, *, loop: bool) -> Document:
    """Set whether the end leads back to the beginning."""
    return document if loop == document.loop else replace(document, loop=loop)


@command("Set interpolation")
def set_variant(document: Document, variant: Variant) -> Document:
    """Set how the in-betweens are made."""
    return document if variant == document.variant else replace(document, variant=variant)


@command("Set anchor")
def set_anchor(document: Document, anchor: complex | None) -> Document:
    """Set the point whose place and turn are blended directly; None lets the engine choose."""
    return document if anchor == document.anchor else replace(document, anchor=anchor)


@command("Set export")
def set_export(document: Document, export: ExportSettings) -> Document:
    """Set what the next export makes."""
    return document if export == document.export else replace(document, export=export)


@command("Set bounds")
def set_bounds(document: Document, bounds: Bounds, poses: Sequence[Pose] | None = None) -> Document:
    """Set the distortion that is allowed.

    Parameters
    ----------
    document : Document
    bounds : Bounds
    poses : sequence of Pose, optional
        One for each key, solved within the new bounds; without them the keys stay as they are.
    """
    keys = document.keys if poses is None else _posed(document, poses)
    if bounds == document.bounds and keys is document.keys:
        return document
    return replace(document, bounds=bounds, keys=keys)


@command("Rebuild domain")
def replace_domain(
    document: Document, domain: Domain, meshing: Meshing, poses: Sequence[Pose]
) -> Document:
    """Put another domain under the same handles and keys.

    Parameters
    ----------
    document : Document
    domain : Domain
        It must contain every handle and the anchor.
    meshing : Meshing
        What it was built with.
    poses : sequence of Pose
        One for each key, solved again over the new cage.
    """
    unknown = {name: value for name, value in document.unknown.items() if name != "domain"}
    return replace(
        document, domain=domain, meshing=meshing, keys=_posed(document, poses), unknown=unknown
    )


def _posed(document: Document, poses: Sequence[Pose]) -> tuple[Keyframe, ...]:
    if len(poses) != len(document.keys):
        raise LissomError(f"There are {len(document.keys)} keys, but {len(poses)} poses for them.")
    return tuple(replace(key, pose=pose) for key, pose in zip(document.keys, poses, strict=True))

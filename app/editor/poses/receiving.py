"""Where what was copied goes: onto which layers, by which handles, and why it cannot."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np

from app.document import Document, Figure, SidePairs, mirrored_name
from app.editor.project import Project
from app.editor.session import CopiedKeys, Session
from app.solving import Carriage, Likeness

# As it is; with pairs of layers and of handles exchanged; or with all of it mirrored, too.
PasteWay = Literal["as it is", "swapped", "flipped"]
NOTHING_COPIED = "Copy a pose or keys first."
MOST_NAMED = 3  # handles in a sentence


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Landing:
    """A figure that takes keys over, and from which of their handles.

    Parameters
    ----------
    figure : Figure
    copied : CopiedKeys
    pairs : mapping of int to int
        The figure's handles, and those of the figure that was copied, by their ids.
    is_own : bool
        Whether they are the figure's own keys, on the same domain and handles.
    """

    figure: Figure
    copied: CopiedKeys
    pairs: Mapping[int, int]
    is_own: bool

    @property
    def hindrance(self) -> str:
        """In a sentence why nothing is taken over; empty where it is."""
        figure, source = self.figure, self.copied.figure
        if figure.still:
            return f"“{figure.name}” is a still picture, which has no poses."
        if self.is_own or self.pairs:
            return ""
        if not source.handles:
            return (
                f"“{source.name}” was copied, which has no handles; by their names poses come to "
                "other layers."
            )
        names = [handle.name for handle in source.handles]
        if len(names) > MOST_NAMED + 1:
            names = [*names[:MOST_NAMED], f"{len(names) - MOST_NAMED} others"]
        *some, last = names
        listed = f"{', '.join(some)} or {last}" if some else last
        return f"“{figure.name}” has no handle called {listed}."

    def is_direct(self, way: PasteWay) -> bool:
        """Tell whether the poses are taken as they are."""
        stays = all(identity == other for identity, other in self.pairs.items())
        return self.is_own and (way == "as it is" or (way == "swapped" and stays))

    def carriage(self, way: PasteWay) -> Carriage:
        """Return the way from the poses that were copied to this figure's."""
        source, likeness = self.copied.figure, Likeness()
        if self.is_own and way == "flipped":
            likeness = Likeness.reflection(self.figure.axis)
        elif not self.is_own:
            handles = self.pairs.items()
            places = np.array([source.handle(other).position for _, other in handles])
            images = np.array([self.figure.handle(identity).position for identity, _ in handles])
            likeness = Likeness.of(places, images, mirrors=True if way == "flipped" else None)
        return Carriage(source=source, pairs=self.pairs, likeness=likeness, is_within=self.is_own)


def landings(session: Session, project: Project, way: PasteWay) -> list[Landing]:
    """Return which figures take over what was copied, each of them once.

    Keys of several figures go to those that they are of, by their names, or to the partners of
    these. Keys of one go to that which is posed, or to all that are chosen; where sides exchange,
    the one that is posed gives its own to its partner.
    """
    found = _landings(session, project, way)
    return [each for each in found if not each.hindrance]


def landing_here(session: Session, project: Project, way: PasteWay) -> Landing | None:
    """Return how the figure that is posed takes over what was copied; None where it is not to."""
    copied = session.copied
    if len(copied) == 1:
        return landing_on(project.document, copied[0], project.figure, way)
    found = _landings(session, project, way)
    return next((e for e in found if e.figure.id == project.active and e.copied.keys), None)


def hindrance(session: Session, project: Project, way: PasteWay) -> str:
    """Return in a sentence why the keys that were copied cannot be pasted; empty where they can."""
    copied = _copied(session)
    if not copied:
        return NOTHING_COPIED
    found = _landings(session, project, way)
    if not found:
        names = ", ".join(f"“{each.figure.name}”" for each in copied[:MOST_NAMED])
        return f"No layer of this drawing is called {names}, as those that were copied are."
    reasons = [landing.hindrance for landing in found]
    if all(reasons):
        return reasons[0]
    if way == "swapped" and all(
        each.is_direct(way) for each, reason in zip(found, reasons, strict=True) if not reason
    ):
        return (
            "Nothing changes sides: no layer and no handle that was copied has a partner by its "
            "name. The Poses tab tells which names are pairs."
        )
    return ""


def left_out(session: Session, project: Project, way: PasteWay) -> list[str]:
    """Return in sentences which of several layers take nothing over, and why."""
    found = _landings(session, project, way)
    return [landing.hindrance for landing in found if landing.hindrance]


def landing_on(document: Document, copied: CopiedKeys, figure: Figure, way: PasteWay) -> Landing:
    """Return how a figure takes keys over."""
    source = copied.figure
    names = {handle.id: handle.name for handle in source.handles}
    is_own = source.domain is figure.domain and (
        source.id == figure.id
        or all(names.get(each.id, each.name) == each.name for each in figure.handles)
    )
    pairs = common_handles(source, figure, document.pairs, way)
    return Landing(figure=figure, copied=copied, pairs=pairs, is_own=is_own)


def common_handles(
    source: Figure, figure: Figure, pairs: SidePairs, way: PasteWay
) -> Mapping[int, int]:
    """Return which of a figure's handles take over from which of another's, by their names.

    Where sides are exchanged, a handle takes over from its partner on the other side. Between
    layers whose handles have no name in common it does so, too.
    """
    theirs = {handle.name: handle.id for handle in source.handles}
    ours = {handle.name: handle.id for handle in figure.handles}
    same = {identity: theirs[name] for name, identity in ours.items() if name in theirs}
    if way == "as it is" and (same or source.id == figure.id):
        return same
    found = {}
    for name, identity in ours.items():
        other = mirrored_name(name, pairs)
        if other in theirs:
            found[identity] = theirs[other]
        elif identity in same and other not in ours:
            found[identity] = same[identity]
    return found


def _landings(session: Session, project: Project, way: PasteWay) -> list[Landing]:
    found: dict[int, Landing] = {}
    document, copied = project.document, _copied(session)
    for each in copied:
        for figure in _receivers(project, each.figure, way, is_alone=len(copied) == 1):
            found.setdefault(figure.id, landing_on(document, each, figure, way))
    return list(found.values())


def _copied(session: Session) -> list[CopiedKeys]:
    """Return the keys that were copied of each figure; none where only those of tracks were."""
    copied = {each.figure.id: each for each in session.copied}
    for each in session.copied_tracks:
        copied.setdefault(each.figure.id, CopiedKeys(each.figure, ()))
    return list(copied.values())


def _receivers(
    project: Project, source: Figure, way: PasteWay, *, is_alone: bool
) -> Iterator[Figure]:
    """Yield the figures that take over what was copied of another one."""
    document = project.document
    names = {figure.name: figure for figure in document.figures}
    # A layer may have been given another name since.
    kin = (each for each in document.figures if each.id == source.id)
    own = names.get(source.name) or next((f for f in kin if f.domain is source.domain), None)
    if is_alone and way == "as it is":
        yield from map(document.figure, project.selected_layers)
    elif is_alone and (own is None or own.id != project.active):
        yield project.figure
    elif own is not None:
        other = None if way == "as it is" else mirrored_name(own.name, document.pairs)
        yield own if other is None else names.get(other, own)

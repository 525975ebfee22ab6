"""Destinations of copied keys: layers, handles, and reasons why a paste is impossible."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np

from app.document import Document, Layer, SidePairs, mirrored_name
from app.editor.parts.clipboard import CopiedKeys
from app.editor.project import Project
from app.editor.session import Session
from app.solving import PoseTransfer, SimilarityTransform
from app.texts import _, ngettext

# Unchanged; with partner layers and handles swapped; or swapped and mirrored.
PasteMode = Literal["as it is", "swapped", "flipped"]
NOTHING_COPIED = _("Copy a pose or keys first.")
MOST_NAMED = 3  # most names in a sentence


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PasteDestination:
    """A layer that can take copied keys.

    Attributes
    ----------
    pairs : mapping of int to int
        The copied layer's handles by the layer's handles, as ids.
    is_own : bool
        Whether the keys are the layer's own, with the same domain and handles.
    """

    layer: Layer
    copied: CopiedKeys
    pairs: Mapping[int, int]
    is_own: bool

    @property
    def disabled_reason(self) -> str | None:
        """The reason why the layer cannot take the keys, as a sentence; None if it can."""
        layer, source = self.layer, self.copied.layer
        if layer.still:
            text = _("“{layer}” is a still picture. Make it posable first.")
            return text.format(layer=layer.name)
        if self.is_own or self.pairs:
            return None
        if not source.handles:
            text = _("The copied layer “{layer}” has no handles. Add handles and copy it again.")
            return text.format(layer=source.name)
        names = [handle.name for handle in source.handles]
        if len(names) > MOST_NAMED + 1:
            count = len(names) - MOST_NAMED
            others = ngettext("{count} other", "{count} others", count).format(count=count)
            names = [*names[:MOST_NAMED], others]
        *some, last = names
        if some:
            text = _("“{layer}” has no handle called {names} or {last}.")
            return text.format(layer=layer.name, names=", ".join(some), last=last)
        return _("“{layer}” has no handle called {name}.").format(layer=layer.name, name=last)

    def is_direct(self, way: PasteMode) -> bool:
        """Return whether the poses are pasted unchanged."""
        stays = all(identity == other for identity, other in self.pairs.items())
        return self.is_own and (way == "as it is" or (way == "swapped" and stays))

    def pose_transfer(self, way: PasteMode) -> PoseTransfer:
        """Return the transfer of copied poses to this layer."""
        source, similarity = self.copied.layer, SimilarityTransform()
        if self.is_own and way == "flipped":
            similarity = SimilarityTransform.reflection(self.layer.axis)
        elif not self.is_own:
            handles = self.pairs.items()
            places = np.array([source.handle(other).position for _, other in handles])
            images = np.array([self.layer.handle(identity).position for identity, _ in handles])
            similarity = SimilarityTransform.fit(
                places, images, mirrors=True if way == "flipped" else None
            )
        return PoseTransfer(
            source=source, pairs=self.pairs, similarity=similarity, is_within_layer=self.is_own
        )


def find_paste_destinations(
    session: Session, project: Project, way: PasteMode
) -> list[PasteDestination]:
    """Return the layers that take the copied keys, each of them once.

    Keys of several layers go to the layers of the same names, or to their partners. Keys of one
    layer go to the active layer or to all selected layers. A swap on the copied layer goes to its
    partner.
    """
    found = _find_paste_destinations(session, project, way)
    return [each for each in found if not each.disabled_reason]


def find_active_paste_destination(
    session: Session, project: Project, way: PasteMode
) -> PasteDestination | None:
    """Return the active layer as a destination; None if it takes nothing."""
    copied = session.clipboard.poses
    if len(copied) == 1:
        return find_paste_destination(project.document, copied[0], project.layer, way)
    found = _find_paste_destinations(session, project, way)
    return next(
        (e for e in found if e.layer.id == project.selection.active and e.copied.keys), None
    )


def paste_keys_disabled_reason(session: Session, project: Project, way: PasteMode) -> str | None:
    """Return why the copied keys cannot be pasted, as a sentence; None if they can."""
    copied = _copied(session)
    if not copied:
        return NOTHING_COPIED
    found = _find_paste_destinations(session, project, way)
    if not found:
        names = ", ".join(f"“{each.layer.name}”" for each in copied[:MOST_NAMED])
        text = _("No layer here is named like a copied layer. Name a layer {names} first.")
        return text.format(names=names)
    reasons = [landing.disabled_reason for landing in found]
    if all(reasons):
        return reasons[0]
    if way == "swapped" and all(
        each.is_direct(way) for each, reason in zip(found, reasons, strict=True) if not reason
    ):
        return _(
            "Nothing was swapped: no copied layer or handle has a partner. "
            "Set the pairs of names in the Animate tab."
        )
    return None


def skipped_layers_reasons(session: Session, project: Project, way: PasteMode) -> list[str]:
    """Return the reasons of layers that take no keys, one sentence each."""
    found = _find_paste_destinations(session, project, way)
    return [landing.disabled_reason for landing in found if landing.disabled_reason]


def find_paste_destination(
    document: Document, copied: CopiedKeys, layer: Layer, way: PasteMode
) -> PasteDestination:
    """Return a layer as a destination of copied keys."""
    source = copied.layer
    names = {handle.id: handle.name for handle in source.handles}
    is_own = source.domain is layer.domain and (
        source.id == layer.id
        or all(names.get(each.id, each.name) == each.name for each in layer.handles)
    )
    pairs = match_handles(source, layer, document.pairs, way)
    return PasteDestination(layer=layer, copied=copied, pairs=pairs, is_own=is_own)


def match_handles(
    source: Layer, layer: Layer, pairs: SidePairs, way: PasteMode
) -> Mapping[int, int]:
    """Match a layer's handles to another layer's handles by their names.

    In a swap, a handle gets its partner on the other side. Layers without a common handle name are
    matched by partners as well.
    """
    theirs = {handle.name: handle.id for handle in source.handles}
    ours = {handle.name: handle.id for handle in layer.handles}
    same = {identity: theirs[name] for name, identity in ours.items() if name in theirs}
    if way == "as it is" and (same or source.id == layer.id):
        return same
    found = {}
    for name, identity in ours.items():
        other = mirrored_name(name, pairs)
        if other in theirs:
            found[identity] = theirs[other]
        elif identity in same and other not in ours:
            found[identity] = same[identity]
    return found


def _find_paste_destinations(
    session: Session, project: Project, way: PasteMode
) -> list[PasteDestination]:
    found: dict[int, PasteDestination] = {}
    document, copied = project.document, _copied(session)
    for each in copied:
        for layer in find_receiving_layers(project, each.layer, way, is_alone=len(copied) == 1):
            found.setdefault(layer.id, find_paste_destination(document, each, layer, way))
    return list(found.values())


def _copied(session: Session) -> list[CopiedKeys]:
    """Return the copied keys of each layer; none if only track keys were copied."""
    copied = {each.layer.id: each for each in session.clipboard.poses}
    others = [each.layer for each in session.clipboard.tracks]
    for layer in filter(None, [*others, *(each.layer for each in session.clipboard.channels)]):
        copied.setdefault(layer.id, CopiedKeys(layer, ()))
    return list(copied.values())


def find_receiving_layers(
    project: Project, source: Layer, way: PasteMode, *, is_alone: bool
) -> Iterator[Layer]:
    """Yield the layers that take the copied keys of a layer."""
    document = project.document
    names = {layer.name: layer for layer in document.layers}
    # A layer may have been renamed since.
    kin = (each for each in document.layers if each.id == source.id)
    own = names.get(source.name) or next((f for f in kin if f.domain is source.domain), None)
    if is_alone and way == "as it is":
        yield from map(document.layer, project.selected_layers)
    elif is_alone and (own is None or own.id != project.selection.active):
        yield project.layer
    elif own is not None:
        other = None if way == "as it is" else mirrored_name(own.name, document.pairs)
        yield own if other is None else names.get(other, own)

"""A drawing on several layers, and what its readers share."""

import io
from collections import Counter
from collections.abc import Hashable, Sequence
from dataclasses import dataclass, replace
from itertools import groupby
from typing import NamedTuple

import numpy as np
from PIL import Image

from app.document import MAX_GROUP_DEPTH, BlendMode, Group, ancestor_paths
from app.errors import (
    EMPTY_IMPORT_LOG,
    ImportLog,
    LissomError,
    NoticeCollector,
    display_name,
    shortened,
)
from app.storage.pictures.parallel import require_memory, run_parallel
from app.storage.pictures.picture import Picture
from engine.arrays import readonly

MOST_LAYERS = 200
MOST_GROUPS = 10_000
LONGEST_NAME = 1_000  # characters of a layer or a group
EMPTY = "left out, since it is empty"
# Of a layer's pixels: where no more of them are within the box of what is drawn, the rest is cut
# off. Decoded, and on the graphics card, every pixel takes memory.
CUT_OFF = 0.8
GROUPS_DEEP = "its groups lie more than {most} deep in each other"


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ImportedLayer:
    """A layer of a drawing.

    Parameters
    ----------
    name : str
        Unique in its drawing.
    data : bytes
        The layer's picture as a file.
    picture : Picture
        The same, decoded.
    corner : complex
        Where its lower left corner is on the canvas, in pixels, y up.
    visible : bool
        By itself, whatever its groups.
    opacity : float
        In [0, 1].
    blend : BlendMode
    clipped : bool
        Whether it is seen only where what lies below it in its group is.
    group : str
        The path of the group that it is in, "" where there is none.
    """

    name: str
    data: bytes
    picture: Picture
    corner: complex = 0j
    visible: bool = True
    opacity: float = 1.0
    blend: BlendMode = "normal"
    clipped: bool = False
    group: str = ""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LayeredPicture:
    """A drawing on layers.

    Parameters
    ----------
    size : tuple of int
        Width and height of the canvas in pixels.
    layers : tuple of ImportedLayer
        From the one behind all others to the one in front; there is always one.
    summary : ImportLog
    groups : tuple of Group
        Those of the layers, each after the one that it is in.
    """

    size: tuple[int, int]
    layers: tuple[ImportedLayer, ...]
    summary: ImportLog = EMPTY_IMPORT_LOG
    groups: tuple[Group, ...] = ()


class UniqueNames:
    """Names as they are given out: one that is taken gets the next number that is free.

    However many of them are alike, each takes as little time.
    """

    def __init__(self) -> None:
        self._taken: set[str] = set()
        self._next: dict[str, int] = {}

    def claim(self, name: str) -> str:
        """Take a name, with a number where it needs one, and return it."""
        free, number = name, self._next.get(name, 2)
        while free in self._taken:
            free, number = f"{name} {number}", number + 1
        self._next[name] = number
        self._taken.add(free)
        return free


class GroupPaths:
    """The groups of a drawing as they are found, each with a path of its own."""

    def __init__(self) -> None:
        self._names = UniqueNames()
        self._found: dict[str, Group] = {}

    def add(self, around: str, group: Group) -> str:
        """Take in a group by its name, that is in the one with the path `around`; return its path.

        Raises
        ------
        LissomError
            If it lies too deep in others, there are too many, or its name is too long.
        """
        if around.count("/") + bool(around) >= MAX_GROUP_DEPTH:
            raise LissomError(GROUPS_DEEP.format(most=MAX_GROUP_DEPTH))
        if len(self._found) == MOST_GROUPS:
            raise LissomError(
                f"it has more than {MOST_GROUPS:,} groups, which Lissom does not take: merge some"
            )
        # A slash stands between groups.
        name = display_name(group.name).replace("/", "-").strip() or "group"
        check_name_length(name)
        path = self._names.claim(f"{around}/{name}" if around else name)
        self._found[path] = replace(group, name=path)
        return path

    def is_clipped(self, path: str) -> bool:
        """Tell whether a group is seen only where what lies below it is."""
        return self._found[path].clipped

    def groups_of(self, layers: Sequence[ImportedLayer]) -> tuple[Group, ...]:
        """Return the groups that these layers are in."""
        filled = {path for layer in layers for path in ancestor_paths(layer.group)}
        return tuple(group for path, group in self._found.items() if path in filled)


def build_layered_picture(
    size: tuple[int, int], found: Sequence[ImportedLayer], groups: GroupPaths, told: NoticeCollector
) -> LayeredPicture:
    """Return the drawing of the layers that were found, each with a name of its own.

    Parameters
    ----------
    size : tuple of int
    found : sequence of ImportedLayer
        From back to front; those of which nothing is to be seen are left out.
    groups : GroupPaths
        All of them.
    told : NoticeCollector
        About the layers, and added to.
    """
    kept = _drawn_layers(found, groups, told)
    if not kept:
        raise LissomError("it has no layer on which anything is drawn")
    # Layers may share a picture.
    distinct = list({id(layer.picture): layer for layer in kept}.values())
    made = run_parallel(_trimmed, distinct, (layer.picture.size for layer in distinct))
    trimmed = {id(layer.picture): each for layer, each in zip(distinct, made, strict=True)}
    kept = [trimmed[id(layer.picture)].of(layer) for layer in kept]
    own = Counter(layer.name for layer in kept)
    names = UniqueNames()
    layers = []
    for layer in kept:
        check_name_length(layer.name)
        has_twin = layer.group and own[layer.name] > 1
        name = f"{layer.group}/{layer.name}" if has_twin else layer.name
        layers.append(replace(layer, name=names.claim(name)))
    return LayeredPicture(
        size=size, layers=tuple(layers), summary=told.import_log, groups=groups.groups_of(layers)
    )


def _drawn_layers(
    layers: Sequence[ImportedLayer], groups: GroupPaths, told: NoticeCollector, depth: int = 0
) -> list[ImportedLayer]:
    """Return those of some layers, that are in the same groups so deep, of which a pixel is seen.

    What is clipped by an empty layer or group is nowhere.
    """

    def unit(layer: ImportedLayer) -> Hashable:
        """Return the group that lies next among these, or the layer."""
        return (*ancestor_paths(layer.group)[depth : depth + 1], layer)[0]

    seen: list[ImportedLayer] = []
    empty = ""  # the last thing that clips others, where nothing is drawn on it
    for found, each in groupby(layers, unit):
        run = list(each)
        path = found if isinstance(found, str) else ""
        is_clipped = groups.is_clipped(path) if path else run[0].clipped
        if is_clipped and empty:
            for layer in run:
                told.add_note(layer.name, f"left out, since it is clipped by the empty {empty}")
            continue
        drawn = (
            _drawn_layers(run, groups, told, depth + 1)
            if path
            else _layer_unless_blank(run[0], told)
        )
        if not is_clipped:
            name = f"group {path.rpartition('/')[2]}" if path else f"layer {run[0].name}"
            empty = "" if drawn else name
        seen += drawn
    return seen


def _layer_unless_blank(layer: ImportedLayer, told: NoticeCollector) -> list[ImportedLayer]:
    """Return a layer, or nothing where it is empty, which is told."""
    is_empty = is_blank(layer.picture)
    if is_empty:
        told.add_note(layer.name, EMPTY)
    return [] if is_empty else [layer]


def is_blank(picture: Picture) -> bool:
    """Tell whether nothing at all is drawn on a picture."""
    return not picture.rgba[..., 3].any()


class _Trimmed(NamedTuple):
    """A picture without empty pixels around it, and how far its corner has moved."""

    data: bytes
    picture: Picture
    shift: complex

    def of(self, layer: ImportedLayer) -> ImportedLayer:
        """Return a layer with this picture."""
        corner = layer.corner + self.shift
        return replace(layer, data=self.data, picture=self.picture, corner=corner)


def _trimmed(layer: ImportedLayer) -> _Trimmed:
    """Return a layer's picture without empty pixels around what is drawn, where they are many."""
    picture, (width, height) = layer.picture, layer.picture.size
    drawn = picture.rgba[..., 3] > 0
    top, bottom = np.flatnonzero(drawn.any(axis=1))[[0, -1]].tolist()
    left, right = np.flatnonzero(drawn.any(axis=0))[[0, -1]].tolist()
    # One more each way: what is opaque all over would be a picture that stands still.
    top, left = max(top - 1, 0), max(left - 1, 0)
    bottom, right = min(bottom + 1, height - 1), min(right + 1, width - 1)
    if (right - left + 1) * (bottom - top + 1) > CUT_OFF * width * height:
        return _Trimmed(layer.data, picture, 0j)
    rgba = readonly(picture.rgba[top : bottom + 1, left : right + 1])
    return _Trimmed(
        encode_png(Image.fromarray(rgba)),
        replace(picture, rgba=rgba, suffix=".png"),
        complex(left, height - 1 - bottom),
    )


def encode_png(image: Image.Image) -> bytes:
    """Return the PNG file of a picture, packed in little time."""
    file = io.BytesIO()
    image.save(file, "PNG", compress_level=1)
    return file.getvalue()


def check_layer_count(count: int) -> None:
    """Refuse more layers than there is room for, before anything of them is read."""
    if count > MOST_LAYERS:
        raise LissomError(
            f"it has {count:,} layers; Lissom takes up to {MOST_LAYERS}: merge some of them"
        )


def check_name_length(name: str) -> None:
    """Refuse a name that would be told and shown everywhere, and stands in those of all inside."""
    if len(name) > LONGEST_NAME:
        raise LissomError(
            f"the name {shortened(name)!r} has {len(name):,} characters; Lissom takes up to "
            f"{LONGEST_NAME:,}: shorten it"
        )


def check_memory(sizes: Sequence[tuple[int, int]]) -> None:
    """Refuse more layers, or larger ones, than there is room for, before they are decoded."""
    check_layer_count(len(sizes))
    require_memory(sizes)


def corner_from_top(left: float, top: float, size: tuple[int, int], height: int) -> complex:
    """Return a layer's lower left corner, y up on a canvas so high, from its upper left one."""
    return complex(left, height - top - size[1])

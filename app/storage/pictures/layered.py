"""A layered drawing, and the code shared by its readers."""

import io
from collections import Counter
from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import groupby
from typing import NamedTuple

import numpy as np
from PIL import Image

from app.document import BlendMode, DrawingFile, FileLayer, Group, ancestor_paths
from app.errors import EMPTY_IMPORT_LOG, ImportLog, LissomError, NoticeCollector
from app.storage.pictures.layer_names import GroupPaths, UniqueNames, check_name_length
from app.storage.pictures.parallel import require_memory, run_parallel
from app.storage.pictures.picture import Picture
from app.texts import N_, _
from engine.arrays import Bytes, readonly

MOST_LAYERS = 1_000
EMPTY = N_("left out, because it is empty")
# Of a layer's pixels. If the box of the opaque pixels has fewer, the rest is cut off. Every decoded
# pixel takes memory, also on the graphics card.
CUT_OFF = 0.8
BACKGROUND = 0.95  # of the canvas: an opaque layer that covers as much is a background


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ImportedLayer:
    """A layer of an imported drawing.

    Parameters
    ----------
    name : str
        Unique in its drawing.
    data : bytes
        The layer's picture as a file.
    picture : Picture
        The same picture, decoded.
    corner : complex
        Lower left corner on the canvas, in pixels, y up.
    visible : bool
        The layer's own visibility, independent of its groups.
    clipped : bool
        Whether the layer is clipped by the content below it in its group.
    group : str
        Path of its group; "" outside groups.
    own_name : str
        Its name in the file, which may occur several times.
    number : int
        Its id in the file; 0 without one.
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
    own_name: str = ""
    number: int = 0

    @property
    def file_layer(self) -> FileLayer:
        """The layer as it is in its file, without its picture."""
        return FileLayer(
            name=self.own_name or self.name,
            group=self.group,
            number=self.number,
            opacity=self.opacity,
            blend=self.blend,
            clipped=self.clipped,
            hidden=not self.visible,
        )


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LayeredPicture:
    """A layered drawing.

    Parameters
    ----------
    size : tuple of int
        Width and height of the canvas in pixels.
    layers : tuple of ImportedLayer
        Back to front; never empty.
    groups : tuple of Group
        All groups of the layers; a group follows its parent.
    merge : callable
        Decodes the merged picture that the file contains beside its layers; None if it is missing
        or damaged.
    file_name, sha256 : str
        Of the file; "" until it is known.
    is_merged : bool
        Whether the layers of the file were merged into one picture.
    """

    size: tuple[int, int]
    layers: tuple[ImportedLayer, ...]
    summary: ImportLog = EMPTY_IMPORT_LOG
    groups: tuple[Group, ...] = ()
    merge: Callable[[], Picture | None] = lambda: None
    file_name: str = ""
    sha256: str = ""
    is_merged: bool = False

    def drawing_file(self, identity: int, corner: complex = 0j) -> DrawingFile:
        """Return the file as a value of a document, with its corner on the document's canvas."""
        return DrawingFile(
            id=identity,
            name=self.file_name,
            sha256=self.sha256,
            size=self.size,
            corner=corner,
            layers=tuple(layer.file_layer for layer in self.layers),
            groups=self.groups,
            is_merged=self.is_merged,
        )

    @property
    def is_opaque(self) -> bool:
        """Whether every layer is opaque, as in a flat drawing."""
        return all(layer.picture.is_opaque for layer in self.layers)


def build_layered_picture(
    size: tuple[int, int],
    found: Sequence[ImportedLayer],
    groups: GroupPaths,
    collector: NoticeCollector,
    merge: Callable[[], Picture | None] = lambda: None,
) -> LayeredPicture:
    """Return the drawing of the imported layers, each with a unique name.

    Parameters
    ----------
    found : sequence of ImportedLayer
        Back to front; blank layers are left out.
    groups : GroupPaths
        All groups of the file.
    collector : NoticeCollector
        Collects the notices about the layers.
    """
    kept = _drawn_layers(found, groups, collector)
    if not kept:
        raise LissomError(_("all of its layers are empty; draw on at least one"))
    # Layers may share a picture.
    distinct = list({id(layer.picture): layer for layer in kept}.values())
    made = run_parallel(
        partial(_trimmed, canvas=size), distinct, (layer.picture.size for layer in distinct)
    )
    trimmed = {id(layer.picture): each for layer, each in zip(distinct, made, strict=True)}
    kept = [trimmed[id(layer.picture)].of(layer) for layer in kept]
    own = Counter(layer.name for layer in kept)
    names = UniqueNames()
    layers = []
    for layer in kept:
        check_name_length(layer.name)
        is_repeated = layer.group and own[layer.name] > 1
        name = f"{layer.group}/{layer.name}" if is_repeated else layer.name
        layers.append(replace(layer, name=names.claim(name), own_name=layer.name))
    return LayeredPicture(
        size=size,
        layers=tuple(layers),
        summary=collector.import_log,
        groups=groups.groups_around(layer.group for layer in layers),
        merge=merge,
    )


def _drawn_layers(
    layers: Sequence[ImportedLayer], groups: GroupPaths, collector: NoticeCollector, depth: int = 0
) -> list[ImportedLayer]:
    """Return the layers with at least one visible pixel.

    All given layers share their groups down to `depth`. A layer clipped by an empty layer or group
    is left out.
    """

    def unit(layer: ImportedLayer) -> Hashable:
        """Return the layer's group at this depth, or the layer itself."""
        return (*ancestor_paths(layer.group)[depth : depth + 1], layer)[0]

    seen: list[ImportedLayer] = []
    empty = ""  # a notice about the last clipping base, if nothing is drawn on it
    for found, each in groupby(layers, unit):
        run = list(each)
        path = found if isinstance(found, str) else ""
        is_clipped = groups.is_clipped(path) if path else run[0].clipped
        if is_clipped and empty:
            for layer in run:
                collector.add_note(layer.name, empty)
            continue
        drawn = (
            _drawn_layers(run, groups, collector, depth + 1)
            if path
            else _layer_unless_blank(run[0], collector)
        )
        if not is_clipped:
            clipped_by = (
                _("left out, because the empty group {name} clips it")
                if path
                else _("left out, because the empty layer {name} clips it")
            )
            name = path.rpartition("/")[2] if path else run[0].name
            empty = "" if drawn else clipped_by.format(name=name)
        seen += drawn
    return seen


def _layer_unless_blank(layer: ImportedLayer, collector: NoticeCollector) -> list[ImportedLayer]:
    """Return a layer, or nothing and a notice if it is empty."""
    is_empty = layer.picture.is_blank
    if is_empty:
        collector.add_note(layer.name, _(EMPTY))
    return [] if is_empty else [layer]


class _Trimmed(NamedTuple):
    """A picture without empty pixels around it, and the shift of its corner."""

    data: bytes
    picture: Picture
    shift: complex

    def of(self, layer: ImportedLayer) -> ImportedLayer:
        moved = layer.corner + self.shift
        return replace(layer, data=self.data, picture=self.picture, corner=moved)


def _trimmed(layer: ImportedLayer, canvas: tuple[int, int]) -> _Trimmed:
    """Return a layer's picture without its empty margins, if these are large.

    A margin of one pixel stays or is added, unless the layer is a background: a fully opaque
    picture would become a still picture.
    """
    picture, (width, height) = layer.picture, layer.picture.size
    if picture.is_opaque:
        if _is_background(layer, canvas):
            return _Trimmed(layer.data, picture, 0j)
        return _framed(picture, np.pad(picture.rgba, ((1, 1), (1, 1), (0, 0))), -1 - 1j)
    drawn = picture.rgba[..., 3] > 0
    top, bottom = np.flatnonzero(drawn.any(axis=1))[[0, -1]].tolist()
    left, right = np.flatnonzero(drawn.any(axis=0))[[0, -1]].tolist()
    top, left = max(top - 1, 0), max(left - 1, 0)
    bottom, right = min(bottom + 1, height - 1), min(right + 1, width - 1)
    if (right - left + 1) * (bottom - top + 1) > CUT_OFF * width * height:
        return _Trimmed(layer.data, picture, 0j)
    shift = complex(left, height - 1 - bottom)
    return _framed(picture, picture.rgba[top : bottom + 1, left : right + 1], shift)


def _is_background(layer: ImportedLayer, canvas: tuple[int, int]) -> bool:
    """Return whether the box of a layer covers most of the canvas."""
    corner, size = (layer.corner.real, layer.corner.imag), layer.picture.size
    covered = [
        max(0.0, min(begin + length, whole) - max(begin, 0)) / whole
        for begin, length, whole in zip(corner, size, canvas, strict=True)
    ]
    return covered[0] * covered[1] >= BACKGROUND


def _framed(picture: Picture, rgba: Bytes, shift: complex) -> _Trimmed:
    cut = replace(picture, rgba=readonly(rgba), suffix=".png")
    return _Trimmed(encode_png(Image.fromarray(cut.rgba)), cut, shift)


def encode_png(image: Image.Image) -> bytes:
    """Return the PNG file of a picture, packed fast."""
    file = io.BytesIO()
    image.save(file, "PNG", compress_level=1)
    return file.getvalue()


def check_layer_count(count: int) -> None:
    """Refuse too many layers before any of them is read."""
    if count > MOST_LAYERS:
        raise LissomError(
            _("it has {count:,} layers; Lissom reads at most {most:,}. Merge some of them").format(
                count=count, most=MOST_LAYERS
            )
        )


def check_memory(sizes: Sequence[tuple[int, int]]) -> None:
    """Refuse layers that need too much memory, before they are decoded."""
    check_layer_count(len(sizes))
    require_memory(sizes)


def corner_from_top(left: float, top: float, size: tuple[int, int], height: int) -> complex:
    """Return a layer's lower left corner, y up, from its upper left corner, y down."""
    return complex(left, height - top - size[1])

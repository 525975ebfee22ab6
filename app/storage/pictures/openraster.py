"""Reading OpenRaster files: a zip of `stack.xml` and one PNG per layer.

Krita, MyPaint and GIMP write them. Krita's own files are zips with a merged picture beside layers
in a format of their own.
"""

import io
import zipfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from math import isfinite
from xml.etree import ElementTree as ET

from app.document import BLENDS, BlendMode, Group, ancestor_paths
from app.errors import LissomError, NoticeCollector, shortened
from app.storage.files.reading import DAMAGED_ZIP, open_zip
from app.storage.pictures.layer_names import GroupPaths
from app.storage.pictures.layered import (
    EMPTY,
    ImportedLayer,
    LayeredPicture,
    build_layered_picture,
    check_layer_count,
    check_memory,
    corner_from_top,
)
from app.storage.pictures.picture import (
    Picture,
    decode_picture,
    decode_pictures,
    stored_size,
)
from app.texts import N_, _

MIMETYPE = b"image/openraster"
LARGEST_XML = 4 * 1024 * 1024
# Limit of the pictures' total size beyond twice the file; they are packed already.
MOST_UNPACKED = 16 * 1024 * 1024
LARGEST_PICTURE = 1024 * 1024 * 1024
LARGEST_SIDE = 65_535
DAMAGED_STACK = N_("its stack.xml is damaged, or has a rare encoding; save it as UTF-8")
# Krita writes modes that OpenRaster lacks by names of its own.
MODES: dict[str, BlendMode] = {
    "": "normal",
    "svg:src-over": "normal",
    "svg:src-atop": "normal",
    "svg:plus": "linear-dodge",
    "svg:add": "linear-dodge",
    **{f"svg:{blend}": blend for blend in BLENDS},
    **{f"krita:{blend.replace('-', '_')}": blend for blend in BLENDS},
}
DAMAGE = (*DAMAGED_ZIP, OSError)
KRITA = b"application/x-krita"
MERGED = "mergedimage.png"
NO_KRITA = N_("it is not a Krita file, or it is damaged")
NOT_MERGED = N_("it contains no merged picture; save the drawing as OpenRaster (.ora)")
MERGED_ALONE = N_("only the merged picture was read; for the layers, save the drawing as .ora")


@dataclass(frozen=True, slots=True, kw_only=True)
class _Place:
    """Position and group of an element in the stack."""

    group: str = ""
    x: float = 0.0
    y: float = 0.0


def read_openraster(data: bytes) -> LayeredPicture:
    """Read the layers of an OpenRaster file."""
    try:
        with open_zip(io.BytesIO(data)) as archive:
            return _read(archive)
    except DAMAGE as error:
        raise LissomError(_("it is not an OpenRaster file, or it is damaged")) from error


def read_krita(data: bytes) -> LayeredPicture:
    """Read the merged picture of a Krita file as a drawing of one layer."""
    try:
        with open_zip(io.BytesIO(data)) as archive:
            if _member(archive, "mimetype", 1024).strip() != KRITA:
                raise LissomError(_(NO_KRITA))
            if MERGED not in archive.NameToInfo:
                raise LissomError(_(NOT_MERGED))
            merged = _member(archive, MERGED, LARGEST_PICTURE)
    except DAMAGE as error:
        raise LissomError(_(NO_KRITA)) from error
    collector = NoticeCollector()
    collector.add_warning("picture", _(MERGED_ALONE))
    layer = ImportedLayer(name="picture", data=merged, picture=decode_picture(merged, MERGED))
    return build_layered_picture(layer.picture.size, [layer], GroupPaths(), collector)


def _read(archive: zipfile.ZipFile) -> LayeredPicture:
    if _member(archive, "mimetype", 1024).strip() != MIMETYPE:
        raise LissomError(_("it is not an OpenRaster file"))
    image = _parse(_member(archive, "stack.xml", LARGEST_XML))
    size = (_whole(image, "w"), _whole(image, "h"))
    stack = image.find("stack")
    if image.tag != "image" or stack is None:
        raise LissomError(_("its stack.xml contains no stack of layers"))
    collector, groups = NoticeCollector(), GroupPaths()
    # The file lists the stack from the front.
    elements = list(_layers(stack, _Place(), groups, collector))[::-1]
    check_layer_count(len(elements))
    sources = []
    for element, _place in elements:
        source = element.get("src", "")
        if source not in archive.NameToInfo:
            raise LissomError(
                _("it lacks {source}").format(
                    source=shortened(source) or _("the picture of a layer")
                )
            )
        sources.append(source)
    distinct = list(dict.fromkeys(sources))
    packed = sum(member.compress_size for member in archive.infolist())
    if sum(archive.getinfo(source).file_size for source in distinct) > 2 * packed + MOST_UNPACKED:
        raise LissomError(_("its pictures would unpack to too many bytes for a drawing"))
    members = {source: _member(archive, source, max(1 << 20, packed)) for source in distinct}
    check_memory([stored_size(members[source], source) for source in sources])
    decoded = decode_pictures([(members[source], source) for source in distinct])
    pictures = dict(zip(distinct, decoded, strict=True))
    found: list[ImportedLayer] = []
    for (element, place), source in zip(elements, sources, strict=True):
        member, picture = members[source], pictures[source]
        name = element.get("name", "").strip() or "layer"
        if picture.is_blank:
            # An empty layer is no clipping base: the rest below is.
            collector.add_note(name, _(EMPTY))
            continue
        layer = ImportedLayer(
            name=name,
            data=member,
            picture=picture,
            corner=corner_from_top(place.x, place.y, picture.size, size[1]),
            visible=_is_visible(element),
            opacity=_opacity(element),
            blend=_blend(element, collector),
            clipped=_is_clipped(element),
            group=place.group,
        )
        found.append(
            replace(layer, clipped=layer.clipped and _clips(found, layer, size, collector))
        )
    merged = _member(archive, MERGED, LARGEST_PICTURE) if MERGED in archive.NameToInfo else None
    return build_layered_picture(size, found, groups, collector, partial(_decoded, merged))


def _decoded(merged: bytes | None) -> Picture | None:
    try:
        return None if merged is None else decode_picture(merged, MERGED)
    except LissomError:
        return None


def _clips(
    found: Sequence[ImportedLayer],
    layer: ImportedLayer,
    size: tuple[int, int],
    collector: NoticeCollector,
) -> bool:
    """Return whether a layer is clipped; in this format all content below in its group clips it."""
    depth = len(ancestor_paths(layer.group))
    below = set()
    for each in found:
        if layer.group and layer.group not in ancestor_paths(each.group):
            continue
        is_wide = all(own >= whole for own, whole in zip(each.picture.size, size, strict=True))
        covers = each.picture.is_opaque and is_wide and each.opacity == 1
        if covers and each.visible and not each.corner:
            return False
        if not each.clipped:
            # All layers of a nested group count as one.
            below.add((*ancestor_paths(each.group)[depth : depth + 1], each)[0])
    if len(below) > 1:
        what = _("clipped by the layer directly below, not by all layers below in its group")
        collector.add_warning(layer.name, what)
    return bool(below)


def _layers(
    stack: ET.Element, around: _Place, groups: GroupPaths, collector: NoticeCollector
) -> Iterator[tuple[ET.Element, _Place]]:
    """Yield the layers of a stack and of its groups, from the front."""
    for element in stack:
        place = replace(
            around,
            x=around.x + _number(element, "x", 0.0),
            y=around.y + _number(element, "y", 0.0),
        )
        name = element.get("name", "").strip()
        if element.tag == "layer":
            yield element, place
        elif element.tag == "stack":
            blend = _blend(element, collector)
            group = Group(
                name=name or "group",
                opacity=_opacity(element),
                hidden=not _is_visible(element),
                blend="pass-through" if blend == "normal" and _passes(element) else blend,
                # Without anything below, it is itself what clips the layers above.
                clipped=_is_clipped(element) and element is not stack[-1],
            )
            inner = replace(place, group=groups.add(around.group, group))
            yield from _layers(element, inner, groups, collector)
        else:
            collector.add_warning(
                name or element.tag, _("left out, because Lissom reads only drawn layers")
            )


def _is_visible(element: ET.Element) -> bool:
    return element.get("visibility", "visible") != "hidden"


def _opacity(element: ET.Element) -> float:
    return min(max(_number(element, "opacity", 1.0), 0.0), 1.0)


def _passes(element: ET.Element) -> bool:
    """Return whether a group of this element is pass-through; a faded group never is."""
    return element.get("isolation", "auto") == "auto" and _opacity(element) == 1


def _is_clipped(element: ET.Element) -> bool:
    """Return whether an element is clipped by the content below it.

    Krita writes this as inherited alpha, other programs as an attribute of their own.
    """
    return element.get("composite-op") == "svg:src-atop" or element.get("alpha-preserve") == "true"


def _blend(element: ET.Element, collector: NoticeCollector) -> BlendMode:
    """Return the blend mode of an element. An unsupported mode gives a notice."""
    mode = element.get("composite-op", "")
    if mode not in MODES:
        name = element.get("name", "").strip() or element.tag
        collector.add_warning(
            name,
            _("drawn normally, not in the mode {mode!r}").format(
                mode=shortened(mode.removeprefix("svg:"))
            ),
        )
    return MODES.get(mode, "normal")


class _Builder(ET.TreeBuilder):
    """Builds the elements of a layer stack, in any encoding."""

    def doctype(self, *_names: str | None) -> None:
        """Refuse a document type: its entities could grow without limit."""
        raise LissomError(_("its stack.xml has a document type, which a layer stack must not have"))


def _parse(content: bytes) -> ET.Element:
    try:
        # The builder has refused all entities.
        return ET.fromstring(content, ET.XMLParser(target=_Builder()))  # noqa: S314
    except (ET.ParseError, LookupError, TypeError, ValueError, RecursionError) as error:
        raise LissomError(_(DAMAGED_STACK)) from error


def _member(archive: zipfile.ZipFile, name: str, largest: int) -> bytes:
    member = archive.getinfo(name)
    if member.file_size > largest:
        raise LissomError(
            _("its {name} is too large: {size:,} bytes").format(name=name, size=member.file_size)
        )
    # Reading with the given size never unpacks more.
    with archive.open(member) as packed:
        return packed.read(member.file_size)


def _whole(element: ET.Element, name: str) -> int:
    number = _number(element, name, 0.0)
    if not (number == int(number) and 1 <= number <= LARGEST_SIDE):
        raise LissomError(
            _("its stack.xml gives the canvas a size of {size!r} pixels").format(
                size=shortened(element.get(name))
            )
        )
    return int(number)


def _number(element: ET.Element, name: str, default: float) -> float:
    text = element.get(name)
    try:
        number = default if text is None else float(text)
    except ValueError:
        number = float("nan")
    if not (isfinite(number) and abs(number) <= 1e7):
        raise LissomError(
            _("its stack.xml says {name}={text!r}, which is not a usable number").format(
                name=name, text=shortened(text)
            )
        )
    return number

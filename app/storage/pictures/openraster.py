"""Reading OpenRaster files: a zip of `stack.xml` and one PNG a layer.

Krita, MyPaint and GIMP write them. Groups are flattened: what lies in them stays in its order, with
the group's visibility and opacity.
"""

import io
import zipfile
from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import isfinite
from xml.etree import ElementTree as ET

from app.errors import LissomError
from app.storage.files import DAMAGED_ZIP, opened_zip
from app.storage.pictures.layered import (
    DEEPEST,
    Layer,
    LayeredPicture,
    corner_from_top,
    layered_picture,
    require_few,
    require_room,
)
from app.storage.pictures.picture import decode_pictures, stored_size

MIMETYPE = b"image/openraster"
LARGEST_XML = 4 * 1024 * 1024
# By which all pictures together may outgrow twice the file; they are packed already.
MOST_UNPACKED = 16 * 1024 * 1024
LARGEST_SIDE = 65_535
NORMAL = {"", "svg:src-over"}
DAMAGE = (*DAMAGED_ZIP, OSError)


@dataclass(frozen=True, slots=True, kw_only=True)
class _Place:
    """Where an element of the stack is, with all that the groups around it do to it."""

    group: str = ""
    x: float = 0.0
    y: float = 0.0
    visible: bool = True
    opacity: float = 1.0


def read_openraster(data: bytes) -> LayeredPicture:
    """Read the layers of an OpenRaster file."""
    try:
        with opened_zip(io.BytesIO(data)) as archive:
            return _read(archive)
    except DAMAGE as error:
        raise LissomError("it is not an OpenRaster file, or it is damaged") from error


def _read(archive: zipfile.ZipFile) -> LayeredPicture:
    if _member(archive, "mimetype", 1024).strip() != MIMETYPE:
        raise LissomError("it is not an OpenRaster file")
    image = _parse(_member(archive, "stack.xml", LARGEST_XML))
    size = (_whole(image, "w"), _whole(image, "h"))
    stack = image.find("stack")
    if image.tag != "image" or stack is None:
        raise LissomError("its stack.xml holds no stack of layers")
    notices: list[str] = []
    # The stack counts from the front.
    elements = list(_layers(stack, _Place(), notices, 0))[::-1]
    require_few(len(elements))
    sources = []
    for element, _ in elements:
        source = element.get("src", "")
        if source not in archive.NameToInfo:
            raise LissomError(f"it lacks {source or 'the picture of a layer'}")
        sources.append(source)
    distinct = list(dict.fromkeys(sources))
    packed = sum(member.compress_size for member in archive.infolist())
    if sum(archive.getinfo(source).file_size for source in distinct) > 2 * packed + MOST_UNPACKED:
        raise LissomError("its pictures would unpack to more than any drawing")
    members = {source: _member(archive, source, max(1 << 20, packed)) for source in distinct}
    require_room([stored_size(members[source], source) for source in sources])
    decoded = decode_pictures([(members[source], source) for source in distinct])
    pictures = dict(zip(distinct, decoded, strict=True))
    found = []
    for (element, place), source in zip(elements, sources, strict=True):
        member, picture = members[source], pictures[source]
        name = element.get("name", "").strip() or "layer"
        layer = Layer(
            name=name,
            data=member,
            picture=picture,
            corner=corner_from_top(place.x, place.y, picture.size, size[1]),
            visible=place.visible,
            opacity=place.opacity,
        )
        found.append((place.group, layer))
    return layered_picture(size, found, notices)


def _layers(
    stack: ET.Element, around: _Place, notices: list[str], depth: int
) -> Iterator[tuple[ET.Element, _Place]]:
    """Go through the layers of a stack and of the groups in it, from the front."""
    if depth > DEEPEST:
        raise LissomError(f"its groups lie more than {DEEPEST} deep in each other")
    for element in stack:
        name = element.get("name", "").strip()
        place = _Place(
            group=around.group,
            x=around.x + _number(element, "x", 0.0),
            y=around.y + _number(element, "y", 0.0),
            visible=around.visible and element.get("visibility", "visible") != "hidden",
            opacity=around.opacity * min(max(_number(element, "opacity", 1.0), 0.0), 1.0),
        )
        if element.tag in {"layer", "stack"} and element.get("composite-op", "") not in NORMAL:
            mode = element.get("composite-op", "").removeprefix("svg:")
            notices.append(f"{name!r} is drawn normally, not in the mode {mode!r}")
        if element.tag == "layer":
            yield element, place
        elif element.tag == "stack":
            group = "/".join(part for part in (around.group, name) if part)
            yield from _layers(element, replace(place, group=group), notices, depth + 1)
        else:
            notices.append(f"left out {name or element.tag!r}: Lissom takes drawn layers only")


def _parse(content: bytes) -> ET.Element:
    try:
        text = content.decode("utf-8-sig")
        # A layer stack has no document type: that is where entities that grow are declared.
        if "<!DOCTYPE" in text:
            raise LissomError("its stack.xml has a document type, which no layer stack has")
        return ET.fromstring(text)  # noqa: S314 - no entities are left
    except (ET.ParseError, UnicodeDecodeError, ValueError, RecursionError) as error:
        raise LissomError(f"its stack.xml is damaged ({error})") from error


def _member(archive: zipfile.ZipFile, name: str, largest: int) -> bytes:
    member = archive.getinfo(name)
    if member.file_size > largest:
        raise LissomError(f"its {name} is too large: {member.file_size:,} bytes")
    # With the size given, no more is ever unpacked.
    with archive.open(member) as packed:
        return packed.read(member.file_size)


def _whole(element: ET.Element, name: str) -> int:
    number = _number(element, name, 0.0)
    if not (number == int(number) and 1 <= number <= LARGEST_SIDE):
        raise LissomError(f"its stack.xml gives the canvas a size of {element.get(name)!r} pixels")
    return int(number)


def _number(element: ET.Element, name: str, default: float) -> float:
    text = element.get(name)
    try:
        number = default if text is None else float(text)
    except ValueError:
        number = float("nan")
    if not (isfinite(number) and abs(number) <= 1e7):
        raise LissomError(f"its stack.xml says {name}={text!r}, which is not a number of use")
    return number

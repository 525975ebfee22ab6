"""A child who waves, on layers: arms that pass in front of the body, a blink, and two mouths."""

from __future__ import annotations

import io
import zipfile
from collections.abc import Callable, Sequence
from pathlib import Path

from character import CREAM, SIDES, SKIN, WOOL, Side, boots, dungarees, hands, head, mouth
from curves import blob, ellipse, ribbon
from paint import INK, Canvas, Gradient, Mark
from shapely.geometry import box

SIZE = (1060, 1100)


def _meadow(canvas: Canvas) -> None:
    sky = Gradient(530 + 0j, 530 + 800j, "#a9dcf5", "#f4fbff")
    canvas.flat(box(-10, -10, 1070, 1110), sky)
    for centre, size in ((210 + 190j, 70), (850 + 130j, 56)):
        for step, share in ((-1.1, 0.7), (0.0, 1.0), (1.1, 0.75)):
            canvas.flat(ellipse(centre + step * size, share * size, 0.7 * share * size), "#ffffff")
    for level, colour in ((850, "#9fd389"), (930, "#7fc06c")):
        hill = blob(
            -80 + 1j * (level + 40), 260 + 1j * (level - 30), 640 + 1j * (level + 30),
            1140 + 1j * (level - 20), 1140 + 1300j, -80 + 1300j,
        )  # fmt: skip
        canvas.flat(hill, colour)


def _trunk(canvas: Canvas) -> None:
    trunk = blob(
        440 + 492j, 530 + 476j, 620 + 492j, 652 + 560j, 640 + 640j,
        646 + 740j, 530 + 770j, 414 + 740j, 420 + 640j, 408 + 560j,
    )  # fmt: skip
    canvas.form(trunk, WOOL)


def _body(canvas: Canvas) -> None:
    boots(canvas)
    _trunk(canvas)
    dungarees(canvas)


def _arm(canvas: Canvas, side: Side) -> None:
    hands(canvas, [side])
    sleeve = ribbon(side((200 + 543j, 300 + 540j, 430 + 546j)), [73, 84, 92])
    marks = [Mark(sleeve.strip(a, a + 0.1, -1.2, 1.2), CREAM) for a in (0.08, 0.34, 0.6)]
    canvas.form(sleeve.shape, WOOL, *marks)
    canvas.form(ribbon(side((168 + 512j, 164 + 544j, 168 + 576j)), 26).shape, CREAM)


def _lid(canvas: Canvas, centre: complex) -> None:
    canvas.flat(ellipse(centre - 2j, 47, 57), SKIN)
    canvas.line([centre - 36 + 4j, centre + 22j, centre + 36 + 4j], 9)


def _smile(canvas: Canvas) -> None:
    canvas.line([488 + 416j, 530 + 436j, 572 + 416j], 9, INK)


LAYERS: tuple[tuple[str, Callable[[Canvas], None]], ...] = (
    ("meadow", _meadow),
    ("left arm", lambda canvas: _arm(canvas, SIDES[0])),
    ("body", _body),
    ("head", head),
    ("laugh", mouth),
    ("smile", _smile),
    ("left lid", lambda canvas: _lid(canvas, 462 + 348j)),
    ("right lid", lambda canvas: _lid(canvas, 598 + 348j)),
    ("right arm", lambda canvas: _arm(canvas, SIDES[1])),
)


def save(path: Path) -> None:
    """Write the drawing as an OpenRaster file, from back to front."""
    stack = "".join(
        f'<layer name="{name}" src="data/{index}.png"/>' for index, (name, _) in _numbered()[::-1]
    )
    width, height = SIZE
    with zipfile.ZipFile(path, "w") as file:
        _write(file, "mimetype", b"image/openraster")
        text = f'<image version="0.0.3" w="{width}" h="{height}"><stack>{stack}</stack></image>'
        _write(file, "stack.xml", text.encode())
        for index, (_, draw) in _numbered():
            canvas = Canvas(width, height)
            draw(canvas)
            stream = io.BytesIO()
            canvas.layer().save(stream, "PNG", optimize=True)
            _write(file, f"data/{index}.png", stream.getvalue())


def _numbered() -> Sequence[tuple[int, tuple[str, Callable[[Canvas], None]]]]:
    return list(enumerate(LAYERS))


def _write(file: zipfile.ZipFile, name: str, content: bytes) -> None:
    # The same drawing gives the same bytes, whenever it is saved.
    file.writestr(zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0)), content)

"""Draw the icon of Lissom: `python tests/drawings/icon.py [OUT.png]`."""

from __future__ import annotations

import sys
from pathlib import Path

from curves import ellipse, polygon, ribbon, rounded
from paint import INK, Canvas, Gradient

# With the margin that a canvas adds, the picture has 512 × 512 pixels.
_SIDE = 474
_BACKDROP = Gradient(0j, _SIDE * (1 + 1j), "#3d4f9f", "#2c9c96")
_LIMB = Gradient(120 + 60j, 400 + 400j, "#ffc35a", "#f0663f")


def icon() -> Canvas:
    """Draw a limb that bends to an L, held by three handles."""
    canvas = Canvas(_SIDE, _SIDE)
    square = polygon([0, _SIDE, _SIDE * (1 + 1j), _SIDE * 1j])
    canvas.flat(rounded(square, 104), _BACKDROP)
    limb = ribbon(
        [186 + 92j, 152 + 196j, 172 + 316j, 274 + 366j, 386 + 330j], [80, 104, 122, 104, 76]
    )
    canvas.form(limb.shape, _LIMB, ink=13)
    for centre in (186 + 92j, 180 + 318j, 386 + 330j):
        canvas.flat(ellipse(centre, 33), INK)
        canvas.flat(ellipse(centre, 21), "#ffffff")
    return canvas


if __name__ == "__main__":
    shipped = Path(__file__).parents[2] / "app" / "icon" / "lissom.png"
    icon().save(Path(sys.argv[1]) if len(sys.argv) > 1 else shipped)

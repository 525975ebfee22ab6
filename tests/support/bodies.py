"""Bodies of sticks, one of each kind, and drawings of them."""

from collections.abc import Mapping

import numpy as np
from PIL import Image, ImageDraw

from app.rigging import Body, find_kind, guess_facing

# Places in a picture of this size, y up.
SIZE = 320, 320
FRONT = {
    "hips": 160 + 150j,
    "chest": 160 + 205j,
    "head": 160 + 270j,
    "shoulder.L": 182 + 212j,
    "elbow.L": 220 + 190j,
    "hand.L": 255 + 165j,
    "shoulder.R": 138 + 212j,
    "elbow.R": 100 + 190j,
    "hand.R": 65 + 165j,
    "hip.L": 175 + 140j,
    "knee.L": 180 + 90j,
    "foot.L": 183 + 40j,
    "hip.R": 145 + 140j,
    "knee.R": 140 + 90j,
    "foot.R": 137 + 40j,
}
SIDE = {
    "hips": 150 + 155j,
    "chest": 155 + 215j,
    "head": 165 + 270j,
    "tail": 60 + 130j,
    "elbow.L": 200 + 190j,
    "hand.L": 235 + 200j,
    "knee.L": 190 + 100j,
    "foot.L": 205 + 40j,
    "knee.R": 135 + 100j,
    "foot.R": 95 + 40j,
}
FOUR_LEGS = {
    "hips": 90 + 190j,
    "chest": 225 + 190j,
    "head": 280 + 260j,
    "tail": 35 + 160j,
    "elbow.L": 250 + 110j,
    "hand.L": 250 + 40j,
    "elbow.R": 208 + 110j,
    "hand.R": 205 + 40j,
    "knee.L": 100 + 110j,
    "foot.L": 110 + 40j,
    "knee.R": 55 + 110j,
    "foot.R": 65 + 40j,
}
CHAIN = {f"joint.{number + 1}": complex(30 + 52 * number, 160) for number in range(6)}
JOINTS: Mapping[str, Mapping[str, complex]] = {
    "biped-front": FRONT,
    "biped-side": SIDE,
    "four-legs": FOUR_LEGS,
    "chain": CHAIN,
    "anything": {"low": 160 + 45j, "middle": 150 + 160j, "high": 170 + 270j},
}
# How thick limbs are.
THICK = {"hips": 62, "chest": 56, "head": 70, "tail": 26}


def body(kind: str) -> Body:
    """Return a body of a kind."""
    joints = JOINTS[kind]
    places = np.array(list(joints.values()))
    low = complex(places.real.min(), places.imag.min())
    high = complex(places.real.max(), places.imag.max())
    known = find_kind(kind)
    facing = guess_facing(known, joints, places)
    return Body(kind=known, joints=joints, box=(low, high), facing=facing)


def drawing(kind: str) -> Image.Image:
    """Return a drawing of a body of a kind."""
    picture = Image.new("RGBA", SIZE)
    draw = ImageDraw.Draw(picture)
    if kind == "anything":
        draw.ellipse([60, 30, 260, 290], fill="orchid")
        return picture
    joints, parents = JOINTS[kind], body(kind).parents
    for name, place in joints.items():
        thick = THICK.get(name, 26 if kind != "chain" else 34)
        start = joints[parents[name]] if parents[name] else place
        for share in np.linspace(0.0, 1.0, 30).tolist():
            at = start + share * (place - start)
            x, y, r = at.real, SIZE[1] - at.imag, thick / 2
            draw.ellipse([x - r, y - r, x + r, y + r], fill="orchid")
    return picture


def told(kind: str) -> dict[str, object]:
    """Return its joints as `lissom move` reads them."""
    joints = {name: [at.real, at.imag] for name, at in JOINTS[kind].items()}
    return {"schema": 1, "kind": kind, "joints": joints if kind != "anything" else {}}

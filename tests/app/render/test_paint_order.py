"""Limbs that cross: which one is seen, whole and without a speck of the one behind it."""

from dataclasses import dataclass, replace
from functools import cache

import numpy as np
import pytest
from animations import still_document
from drawings import NEEDS_OSMESA
from PIL import Image, ImageDraw

from app.document import DEPTH, clip_of
from app.document.commands import handle_commands
from app.document.commands.layers import layer_commands
from app.document.keyframe import Keyframe
from app.document.model import Document
from app.motion import DeformMesh, TriangleOrder
from app.render import Backdrop, Scene, View
from engine.arrays import Booleans, Bytes, Complexes

SIZE = 240  # pixels
MIDDLE = 0.5 * SIZE * (1 + 1j)
BODY = 0.13 * SIZE  # radius; from there on arms bend
FULL = 14_000  # triangles: the coarse mesh has fewer, as long as it need not have half as many
RED, BLUE = (230, 40, 30), (20, 60, 220)
# Near where the colours meet, and where the depth comes to nothing, a pixel may show both.
ELBOW = 0.6  # of an arm
BAND = 0.025 * SIZE
FRAMES, CHANGE = (6, 12, 18, 24), 15  # the pose goes on from 0 to 24, the order changes between
LEVELS = 2
VIEW = View(centre=MIDDLE, scale=1.0, size=(SIZE, SIZE))


@dataclass(frozen=True, kw_only=True)
class Star:
    """A body with straight arms, the first of which is of another colour from a place on.

    Parameters
    ----------
    turns : sequence of complex
        The arms' directions, of modulus 1.
    ends, widths, bends : sequence of float
        How far from the middle they reach, half their widths, and their bends in radians.
    extent : float
        Of the depth at the tip of the first arm.
    """

    turns: Complexes
    ends: Complexes
    widths: Complexes
    bends: Complexes
    extent: float

    @classmethod
    def drawn_by(cls, rng: np.random.Generator) -> "Star":
        count = int(rng.integers(3, 6))
        angles = 2 * np.pi * (np.arange(count) + rng.uniform(-0.25, 0.25, count)) / count
        ends = SIZE * rng.uniform(0.38, 0.48, count)
        bends = rng.choice([-1, 1], count) * rng.uniform(2.0, 2.9, count)
        # A limb that is bent by so much must not fold at its inner side.
        widest = np.minimum(0.06 * SIZE, 0.75 * ELBOW * (ends - BODY) / np.abs(bends))
        return cls(
            turns=np.exp(1j * angles),
            ends=ends,
            widths=widest * rng.uniform(0.6, 1.0, count),
            bends=bends,
            extent=rng.choice([0.6, 1.1, 1.5]) * (ends[0] - BODY),
        )

    @property
    def tip(self) -> complex:
        return MIDDLE + self.turns[0] * (self.ends[0] - self.widths[0])

    @property
    def seam(self) -> float:
        """How far from the middle the first arm changes its colour."""
        return max(BODY, self.ends[0] - self.widths[0] - 0.85 * self.extent) + BAND

    def places(self, points: Complexes) -> tuple[Complexes, Complexes]:
        """Return in which arm points are, −1 for the body, and where along and across it."""
        own = (points - MIDDLE) / self.turns[:, None]
        is_in = (own.real > BODY) & (np.abs(own.imag) < self.widths[:, None] + 3 * BAND)
        arms = np.where(is_in.any(axis=0), np.where(is_in, np.abs(own.imag), np.inf).argmin(0), -1)
        return arms, own[arms, np.arange(points.size)]

    def is_red(self, points: Complexes, slack: float = 0.0) -> Booleans:
        arms, own = self.places(points)
        return (arms == 0) & (own.real > self.seam + slack)

    def picture(self) -> Bytes:
        image = Image.new("L", (4 * SIZE, 4 * SIZE))
        draw = ImageDraw.Draw(image)
        for centre, radius in [(MIDDLE, 0.98 * BODY), *self._beads()]:
            low, high = centre.conjugate() + 1j * SIZE - radius * (1 + 1j), 2 * radius
            box = (low.real, low.imag, low.real + high, low.imag + high)
            draw.ellipse([4 * side for side in box], fill=255)
        y, x = np.mgrid[:SIZE, :SIZE] + 0.5
        red = self.is_red((x + 1j * (SIZE - y)).ravel()).reshape(SIZE, SIZE)
        colours = np.where(red[..., None], RED, BLUE)
        return np.dstack([colours, np.asarray(image.reduce(4))]).astype(np.uint8)

    def _beads(self):
        for turn, end, width in zip(self.turns, self.ends, self.widths, strict=True):
            for along in np.linspace(0, end - width, 200):
                yield MIDDLE + turn * along, width

    def bent(self, points: Complexes, share: float) -> Complexes:
        """Bend each arm to an arc, by a share of its bend."""
        arms, own = self.places(points)
        along = np.linspace(0, 1, 400)
        result = points.copy()
        for arm, (end, bend) in enumerate(zip(self.ends, self.bends, strict=True)):
            length = end - BODY
            # All of it within the first part; from there on it is straight again.
            turns = share * bend * np.minimum(along / ELBOW, 1.0)
            onward = np.exp(1j * turns)
            line = BODY + length * np.concatenate([[0], np.cumsum(onward[:-1] + onward[1:]) / 798])
            here = own[arms == arm]
            at = (here.real - BODY) / length
            turned = np.exp(1j * np.interp(at, along, turns))
            beyond = np.maximum(at - 1, 0) * length * turned
            place = np.interp(at, along, line) + beyond + 1j * here.imag * turned
            result[arms == arm] = MIDDLE + self.turns[arm] * place
        return result

    def document(self, *fronts: tuple[complex, float, float]) -> Document:
        """The star at rest, with depths and their extents at some places of it."""
        document = still_document(self.picture(), triangles=FULL)
        for number, (place, depth, extent) in enumerate(fronts):
            document = handle_commands.add_handle(0, place)(document)
            document = layer_commands.set_depth(0, number, depth, extent)(document)
        return document


@cache
def star_and_clip(seed):
    """The arm of another colour behind all else at first, and from a key on in front."""
    star = Star.drawn_by(np.random.default_rng(seed))
    document = star.document((star.tip, -1.0, star.extent))
    layer = document.layers[0]
    first = layer.keys[0]
    keys = (first, Keyframe(frame=CHANGE, pose=first.pose))
    layer = replace(layer, keys=keys).with_keys_of(DEPTH, [DEPTH.key(CHANGE, 1.0)], 0)
    return star, clip_of(document.with_layer(layer), 0)


@pytest.fixture(autouse=True)
def _always_coarse(monkeypatch):
    monkeypatch.setattr("app.motion.meshes.deform_mesh.FINER", 1)


@pytest.mark.parametrize(
    ("gl", "seed", "is_coarse"),
    [
        ("egl", 15, False),
        pytest.param("osmesa", 18, True, marks=NEEDS_OSMESA),
        ("egl", 55, False),
    ],
    indirect=["gl"],
)
def test_no_pixel_of_what_is_behind_shows_through(easel, seed, is_coarse):
    star, clip = star_and_clip(seed)
    posable = DeformMesh.coarse if is_coarse else DeformMesh.fine
    mesh = posable(clip.layer.domain).domain.mesh
    assert (len(mesh.triangles) < len(clip.layer.domain.mesh.triangles)) == is_coarse
    corners = mesh.vertices[mesh.triangles]
    red = star.is_red(corners.ravel(), BAND).reshape(-1, 3).all(axis=1)
    blue = ~star.is_red(corners.ravel(), -2 * BAND).reshape(-1, 3).any(axis=1)
    picture = star.picture()
    crossing = 0
    for frame in FRAMES:
        positions = star.bent(mesh.vertices, frame / FRAMES[-1])

        def drawn(triangles, positions=positions):
            easel_mesh = easel.mesh(picture, mesh.vertices, triangles)
            return easel.frame(VIEW, Scene(meshes=(easel.pose(easel_mesh, positions),))).astype(int)

        order = TriangleOrder(mesh).triangles(clip, frame)
        whole = drawn(order)
        alone = [drawn(mesh.triangles[part])[..., 3] for part in (red, blue, ~(red | blue))]
        is_red, is_blue = (alpha == 255 for alpha in alone[:2])
        is_clear = alone[2] == 0
        assert whole[(is_red | is_blue) & is_clear][:, 3].min() >= 255 - LEVELS
        upper, colour = (is_red, RED) if frame >= CHANGE else (is_blue, BLUE)
        shown = whole[upper & is_clear]
        wrong = np.abs(shown[:, :3] - colour).max(axis=1) > LEVELS
        assert not wrong.any(), (frame, wrong.sum(), star)
        crossing += (is_red & is_blue & is_clear).sum()
    assert crossing > 500


# Its first arm turns back over the second one.
CROSSED = Star(
    turns=np.exp([-0.3j, 0.7j, 2.5j, 4.3j]),
    ends=SIZE * np.array([0.49, 0.46, 0.36, 0.36]),
    widths=SIZE * np.array([0.04, 0.045, 0.05, 0.05]),
    bends=np.array([2.2, 0.01, 0.4, -0.4]),
    extent=60.0,
)
HALFWAY = CROSSED.tip - 32 * CROSSED.turns[0]
ORDERS = {
    "arm_in_front": [(CROSSED.tip, 1.0, 60.0)],
    "arm_behind": [(CROSSED.tip, -1.0, 60.0)],
    # The order changes in the middle of where they cross.
    "arm_woven": [(CROSSED.tip, 1.0, 16.0), (HALFWAY, -1.0, 44.0)],
}


@cache
def crossed(name):
    return CROSSED.picture(), clip_of(CROSSED.document(*ORDERS[name]), 0)


@pytest.mark.parametrize("name", ORDERS)
def test_arms_that_cross(easel, check_golden, name):
    picture, clip = crossed(name)
    paper = Backdrop(colour=(0.97, 0.97, 0.95, 1.0))
    frames = []
    for posable in (DeformMesh.fine, DeformMesh.coarse):
        mesh = posable(clip.layer.domain).domain.mesh
        drawn = easel.mesh(picture, mesh.vertices, TriangleOrder(mesh).triangles(clip, 0))
        pose = easel.pose(drawn, CROSSED.bent(mesh.vertices, 1.0))
        frames.append(easel.frame(VIEW, Scene(background=paper, meshes=(pose,))))
    check_golden(name, frames[0])
    # On the coarse mesh only edges lie elsewhere, by less than a pixel.
    differs = np.abs(frames[1].astype(int) - frames[0]).max(axis=2) > 60
    assert differs.sum() < 60

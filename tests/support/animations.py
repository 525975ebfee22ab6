"""Small animated documents with real pictures, for the tests of exports."""

import io
from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
from documents import altered
from drawings import soft_blob
from interpolation_shapes import around, subdivided
from PIL import Image

from app.cut_out import CutLine, CutOut, build_picture_domain
from app.document.keyframe import Keyframe
from app.document.layer import PictureFile, new_layer
from app.document.model import Document
from app.document.settings import FrameRange, Meshing
from app.motion import (
    DeformMesh,
    Evaluator,
    InbetweenCache,
    LayerFrame,
    LayerStages,
    ParentMotion,
    VertexArray,
)
from engine.arrays import Bytes, Complexes
from engine.domain.build import MeshedDomain
from engine.domain.meshing.triangulation import triangulate

BLOB = soft_blob()  # 120 × 90 pixels, soft edges, bright colours hidden where it is transparent
LONGEST, OFFSET = 30.0, 4.0  # of edges of simple outlines, and of the cages around them

# A knife's line from below into its middle.
PARTED = CutOut(cut_lines=(CutLine(points=np.array([60.0, 61 + 50j])),))


def still_document(
    picture: Bytes = BLOB, *, triangles: int = 1_000, cut_out: CutOut | None = None
) -> Document:
    """A document of a picture as it was opened, with frames 0 to 48."""
    return _still_document(picture.tobytes(), picture.shape, triangles, cut_out or CutOut())


@cache
def _still_document(
    pixels: bytes, shape: tuple[int, ...], triangles: int, cut_out: CutOut
) -> Document:
    picture = np.frombuffer(pixels, np.uint8).reshape(shape)
    height, width, _ = shape
    stream = io.BytesIO()
    Image.fromarray(picture).save(stream, "PNG")
    file = PictureFile(data=stream.getvalue(), suffix=".png", size=(width, height))
    domain, _ = build_picture_domain(picture, triangles=triangles, detail="normal", cut_out=cut_out)
    layer = new_layer(file, domain, Meshing(triangles=triangles), cut_out)
    return Document(layers=(layer,))


def within(document: Document, corners: Complexes) -> Document:
    """The same picture as it was opened, within a polygon whose edges are cut a few times.

    With a third of the corners, poses and frames are solved several times as fast.
    """
    outline = subdivided(corners, LONGEST)
    cage = around(outline, OFFSET)
    domain = MeshedDomain(outline=outline, cage=cage, mesh=triangulate(outline, 300))
    return Document(layers=(new_layer(document.layers[0].picture, domain, Meshing()),))


def bar_picture(length: int = 240) -> Bytes:
    """A white bar, 20 pixels within a picture of so many."""
    picture = np.zeros((80, length, 4), np.uint8)
    picture[20:60, 20:-20] = 255
    return picture


def bar_document() -> Document:
    """That bar as it was opened, within four corners."""
    corners = np.array([18 + 18j, 222 + 18j, 222 + 62j, 18 + 62j])
    return within(still_document(bar_picture()), corners)


@cache
def round_document() -> Document:
    """The blob as it was opened, within twelve corners."""
    corners = np.exp(1j * np.linspace(0, 2 * np.pi, 13)[:-1])
    return within(still_document(), 60 + 45j + 55 * corners.real + 40j * corners.imag)


def moving_document(last: int = 6, cut_out: CutOut | None = None) -> Document:
    """The blob as it was drawn in frame 0, turned and bent in the last frame."""
    document = still_document(cut_out=cut_out)
    cage, first = document.layers[0].domain.cage, document.layers[0].keys[0]
    middle = cage.mean()
    z = cage - middle
    pose = replace(first.pose, phi=middle + z * np.exp(0.5j) + 5e-4 * z**2)
    keys = (first, Keyframe(frame=last, pose=pose))
    return altered(document, keys=keys, frames=FrameRange(0, last), variant="nu")


class Posed(LayerStages):
    """Stages whose frames are given: vertices of the layer, by a function of the frame."""

    def __init__(self, document: Document, positions: Callable[[float], Complexes]) -> None:
        layer = document.layers[0]
        mesh = DeformMesh.fine(layer.domain)
        super().__init__(layer_id=layer.id, store=InbetweenCache(mesh=mesh))
        self._positions = positions

    def positions(self, frame: float) -> Complexes:
        return self._positions(frame)

    def frame(self, document: Document, frame: float, _carried: ParentMotion) -> LayerFrame:
        clip, mesh = self.clip(document), self.store.mesh
        triangles = mesh.order.triangles(clip, frame)
        vertices = VertexArray(positions=self.positions(frame), triangles=triangles)
        return LayerFrame(clip=clip, frame=frame, pose=None, mesh=mesh, vertices=vertices)


class Sliding(Posed):
    """Vertices that move by so much a frame, from where they are at rest in frame 0."""

    def __init__(self, document: Document, by: complex) -> None:
        rest = document.layers[0].domain.mesh.vertices
        super().__init__(document, lambda frame: rest + by * frame)


def evaluator_of(*stages: LayerStages) -> Evaluator:
    """Return an evaluator of given layers."""
    return Evaluator(layers={each.layer_id: each for each in stages})

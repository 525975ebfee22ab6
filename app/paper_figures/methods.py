"""The compared methods, each from two keyframes to in-betweens at any time."""

from collections.abc import Callable
from dataclasses import dataclass

from app.document import Baseline
from app.motion import MeshFrame, prepare_baseline
from app.paper_figures.shapes import ShapePair
from engine.interpolation import Frame, Prepared, Variant, prepare
from engine.maps import Boundary

# With positions of the vertices. The type of a method's frames never changes: fz and fzbar are at
# vertices or in triangles.
Inbetween = Frame | MeshFrame
FrameAt = Callable[[float], Inbetween]


@dataclass(frozen=True, slots=True, kw_only=True)
class ComparedMethod:
    """A method of interpolation.

    Parameters
    ----------
    name : str
        Printed beside its pictures.
    colour : str
        Of its curves.
    prepare : callable
        From a pair to its in-betweens.
    """

    name: str
    colour: str
    prepare: Callable[[ShapePair], FrameAt]


def prepare_variant(pair: ShapePair, variant: Variant) -> Prepared:
    """Prepare one of our variants at the vertices of a pair's mesh."""
    domain = pair.shape.domain
    return prepare(
        (pair.first, pair.second),
        Boundary.sample(domain),
        domain.mesh.vertices,
        variant=variant,
        triangles=domain.mesh.triangles,
        anchor=pair.anchor,
    )


def variant_preparer(variant: Variant) -> Callable[[ShapePair], FrameAt]:
    """Return the preparation of one of our variants."""
    return lambda pair: prepare_variant(pair, variant).frame


def baseline_preparer(baseline: Baseline) -> Callable[[ShapePair], FrameAt]:
    """Return the preparation of a compared method."""

    def prepare_pair(pair: ShapePair) -> FrameAt:
        domain = pair.shape.domain
        return prepare_baseline(
            baseline,
            (pair.first, pair.second),
            domain.mesh.vertices,
            domain.mesh.triangles,
            outline=domain.outline,
            anchor=pair.anchor,
            handles=pair.handles if baseline is Baseline.HANDLES else None,
            bounds=pair.bounds,
        ).frame

    return prepare_pair


LINEAR = ComparedMethod(name="linear", colour="#8a8f99", prepare=variant_preparer(Variant.LINEAR))
NU = ComparedMethod(name="ν", colour="#3fa796", prepare=variant_preparer(Variant.NU))
ETA = ComparedMethod(name="η", colour="#f2a541", prepare=variant_preparer(Variant.ETA))
SCALED_ETA = ComparedMethod(
    name="scaled η", colour="#7d5ba6", prepare=variant_preparer(Variant.SCALED_ETA)
)
METRIC = ComparedMethod(name="metric", colour="#4a5be0", prepare=variant_preparer(Variant.METRIC))
ARAP = ComparedMethod(name="ARAP", colour="#d9534f", prepare=baseline_preparer(Baseline.ARAP))
FFMP = ComparedMethod(name="FFMP", colour="#c77d2e", prepare=baseline_preparer(Baseline.FFMP))
SIG13 = ComparedMethod(
    name="Chen et al. 2013", colour="#2e7d8c", prepare=baseline_preparer(Baseline.SIG13)
)
HANDLES = ComparedMethod(
    name="handles", colour="#6b7a3a", prepare=baseline_preparer(Baseline.HANDLES)
)
MESH_ETA = ComparedMethod(
    name="mesh η", colour="#a04a8c", prepare=baseline_preparer(Baseline.MESH_ETA)
)
# All timed methods.
METHODS = (LINEAR, NU, ETA, SCALED_ETA, METRIC, ARAP, FFMP, MESH_ETA, HANDLES, SIG13)

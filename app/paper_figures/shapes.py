"""The shapes of the figures, with two keyframes each.

Positions are in pixels, y up, as everywhere.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from app.cut_out import build_picture_domain
from app.storage import cut_picture, decode_picture, load_project, sample_images
from engine.arrays import Bytes, Complexes, Floats
from engine.deform import Deformer, Handles
from engine.domain import Domain, MeshedDomain
from engine.geometry import arc_lengths, edge_vectors
from engine.maps import Boundary, Bounds, HarmonicMap

# The middle line of the letter S in its picture; handles are on both sides of it.
S_MIDDLE = (
    *(586 + 798j, 493 + 893j, 343 + 918j, 183 + 863j, 123 + 728j, 203 + 598j, 343 + 523j),
    *(483 + 448j, 563 + 318j, 503 + 183j, 343 + 128j, 193 + 153j, 93 + 248j),
)
S_RAIL = 50.0  # pixels from the middle line to the handles
S_GROWTH = 1.2  # of the logarithm of the size, from end to end
S_BOUNDS = Bounds(k=0.08, sigma_a=5.0, sigma_b=0.2)
PLACES = 11  # positions of handles along the middle line
ENDS = 0.05  # of its length, left free of handles
LEG = 2  # straight positions along each leg of the U
STEPS = 8  # steps of the deformer to the targets
SOFTNESS = 0.1  # of handles
RING_TURN, RING_GROWTH, RING_NU = 4.9, 0.8, 0.1


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Shape:
    """A drawing on a mesh.

    The picture, uint8 (h, w, 4), has straight alpha. Its lower left corner is the plane's origin.
    """

    picture: Bytes
    domain: MeshedDomain


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ShapePair:
    """A shape and two keyframes of it.

    `anchor` is the fixed point of in-betweens; with None each method chooses its own. `handles` are
    the handles of a deformer that made the keyframes within `bounds`, if any.
    """

    shape: Shape
    first: HarmonicMap
    second: HarmonicMap
    anchor: complex | None = None
    handles: Complexes | None = None
    bounds: Bounds = Bounds()


def square(triangles: int) -> Shape:
    """Return the square [−1, 1]² of Figure 3, 100 pixels per unit, with a checker on it."""
    return _block(200, 200, cells=8, triangles=triangles)


def beam(triangles: int) -> Shape:
    """Return a bar of 6 by 1, with a checker on it."""
    return _block(600, 100, cells=24, triangles=triangles)


def letter_s(triangles: int) -> ShapePair:
    """Return the letter S and the deformer's result on the way to a U.

    The U is larger at one end. If a shape turns and grows, the blended Jacobians of ARAP belong to
    no map. The limit on k is tight, so that all of the shape is sheared nearly as far as its worst
    point. Additional shear by other methods is then visible.
    """
    shape = _sample_picture("s", triangles)
    domain = shape.domain
    boundary = Boundary.sample(domain)
    middle = _along(S_MIDDLE)
    places = _rails(middle, np.full(PLACES, S_RAIL))
    handles = Handles.place(boundary, places, np.full(len(places), SOFTNESS))
    deformer = Deformer(boundary=boundary, handles=handles, bounds=S_BOUNDS)
    turns = np.zeros(PLACES - 2)
    turns[LEG:-LEG] = np.pi / (len(turns) - 2 * LEG)
    state, target = deformer.start(), places
    for share in np.linspace(0, 1, STEPS + 1)[1:]:
        sizes = np.exp(share * S_GROWTH * np.linspace(-0.5, 0.5, PLACES))
        target = _rails(_turned(middle, turns, sizes, float(share)), sizes * S_RAIL)
        state, _ = deformer.track_path_row(state, handles.targets(target))
    state, _ = deformer.settle(state, handles.targets(target), throw=False)
    return ShapePair(
        shape=shape,
        first=HarmonicMap.identity(domain.cage),
        second=state.map,
        anchor=complex(middle[PLACES // 2]),
        handles=places,
        bounds=S_BOUNDS,
    )


def bar_to_ring(triangles: int) -> ShapePair:
    """Return the bar, and the bar wound up to a ring that is thicker at one end.

    ν is −0.1 in the first and 0.1 in the second, everywhere: the stretch turns by a right angle.
    """
    shape = _sample_picture("bar", triangles)
    middle = complex(shape.domain.outline.mean())
    offset = shape.domain.cage - middle
    return ShapePair(
        shape=shape,
        first=HarmonicMap(cage=shape.domain.cage, phi=offset, psi=-RING_NU * offset),
        second=_wound(shape, middle, turn=RING_TURN, growth=RING_GROWTH, nu=RING_NU),
        anchor=middle,
    )


def make_sample_pair(name: str, first: int, second: int, triangles: int) -> ShapePair:
    """Return two keys of a sample project, by their numbers, on a mesh of `triangles` triangles.

    Its poses are the deformer's, and certified.
    """
    path = sample_images() / f"{name}.lissom"
    document = load_project(path)
    (layer,) = document.layers
    domain = layer.domain
    domain = MeshedDomain.of(domain, triangles)
    picture = decode_picture(layer.picture.data, path.name)
    poses = [layer.keys[index].pose for index in (first, second)]
    return ShapePair(
        shape=Shape(picture=cut_picture(picture, layer.cut_out).texture, domain=domain),
        first=layer.map_of(poses[0]),
        second=layer.map_of(poses[1]),
        anchor=layer.anchor,
        handles=np.array([handle.position for handle in layer.handles]),
        bounds=layer.bounds,
    )


def spiral_map(shape: Shape, *, turn: float, growth: float, nu: float) -> HarmonicMap:
    """Return a map that winds a shape up along x and lets it grow, with constant ν.

    Parameters
    ----------
    turn : float
        In radians, over the whole length.
    growth : float
        Of ln |f_z|, over the whole length; 0 at the left end.
    nu : float
        conj(f_z̄) / f_z; k is its modulus.
    """
    outline = shape.domain.outline
    start = complex(outline.real.min(), outline.imag.mean())
    return _wound(shape, start, turn=turn, growth=growth, nu=nu).moved(1, start)


def bend_points(offset: Complexes, *, turn: float, growth: float = 0.0) -> Complexes:
    """Return points about the origin bent so that lines across stay straight.

    They bend by `turn` radians over their extent along x, and grow by exp(`growth`) along it.
    """
    along, across = offset.real, offset.imag
    rate = complex(growth, turn) / float(np.ptp(along))
    turned: Complexes = (np.exp(rate * along) - 1) / rate + 1j * across * np.exp(rate * along)
    return turned


def _wound(shape: Shape, start: complex, *, turn: float, growth: float, nu: float) -> HarmonicMap:
    """Return `spiral_map` with `start` mapped to the origin, without rotation or growth there."""
    cage = shape.domain.cage
    rate = complex(growth, turn) / float(np.ptp(shape.domain.outline.real))
    phi = (np.exp(rate * (cage - start)) - 1) / rate
    return HarmonicMap(cage=cage, phi=phi, psi=nu * phi)


def _block(width: int, height: int, *, cells: int, triangles: int) -> Shape:
    """Return a rectangle about the origin with `cells` squares of a checker along it."""
    side = width / cells
    rows, columns = np.indices((height, width)) // side
    share = columns / (cells - 1)
    light = np.array([255, 244, 220])
    warm, cold = np.array([228, 87, 46]), np.array([58, 124, 165])
    colour = warm + share[..., None] * (cold - warm)
    rgb = np.where(((rows + columns) % 2 == 0)[..., None], colour, light)
    picture = np.dstack([rgb, np.full((height, width), 255)]).astype(np.uint8)
    corners: Complexes = np.array([0, width, width + 1j * height, 1j * height])
    outline = _subdivided(corners, height / 5)
    # Offset by a third of a side's length.
    grown = corners + height / 16 * np.array([-1 - 1j, 1 - 1j, 1 + 1j, -1 + 1j])
    cage = _subdivided(grown, height / 5)
    domain = MeshedDomain.of(Domain(outline, cage), triangles)
    return Shape(picture=picture, domain=domain)


def _subdivided(polygon: Complexes, longest: float) -> Complexes:
    parts = []
    for start, side in zip(polygon, edge_vectors(polygon), strict=True):
        count = int(np.ceil(abs(side) / longest))
        parts.append(start + side * np.arange(count) / count)
    return np.concatenate(parts)


def _sample_picture(name: str, triangles: int) -> Shape:
    picture = decode_picture((sample_images() / f"{name}.png").read_bytes(), "")
    domain, _ = build_picture_domain(picture.rgba, triangles=triangles, detail="normal")
    return Shape(picture=picture.rgba, domain=domain)


def _rails(middle: Complexes, widths: Floats) -> Complexes:
    """Return points on both sides of a curve, (2 PLACES,)."""
    along = np.gradient(middle)
    across = 1j * along / np.abs(along) * widths
    return np.concatenate([middle + across, middle - across])


def _along(middle: Sequence[complex]) -> Complexes:
    """Return evenly spaced points along a smooth curve, without its ends."""
    through = np.array(middle)
    knots = np.concatenate([[0.0], np.cumsum(np.sqrt(np.abs(np.diff(through))))])
    curve = CubicSpline(knots, through)(np.linspace(0, knots[-1], 2001))
    lengths = arc_lengths(curve)
    wanted = np.linspace(ENDS, 1 - ENDS, PLACES) * lengths[-1]
    places: Complexes = np.interp(wanted, lengths, curve.real) + 1j * np.interp(
        wanted, lengths, curve.imag
    )
    return places


def _turned(middle: Complexes, turns: Floats, sizes: Floats, share: float) -> Complexes:
    """Return the chain (PLACES,) with a share of the given turns and sizes; its middle stays."""
    steps = np.diff(middle)
    own = np.angle(steps[1:] / steps[:-1])
    angles = np.concatenate([[0.0], np.cumsum(own + share * (turns - own))])
    lengths = np.abs(steps) * np.sqrt(sizes[1:] * sizes[:-1])
    chain = np.concatenate([[0.0], np.cumsum(lengths * np.exp(1j * angles))])
    half = PLACES // 2
    before, after = (np.gradient(each)[half] for each in (middle, chain))
    turn = before / after
    turned: Complexes = middle[half] + (chain - chain[half]) * turn / abs(turn)
    return turned

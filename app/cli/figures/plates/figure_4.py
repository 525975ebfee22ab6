"""Figure 4: a bar that is wound up and grows, with η as it is and with η scaled."""

from app.cli.figures.easel import box_of
from app.cli.figures.methods import ETA, SCALED_ETA
from app.cli.figures.plates.plate import Plate, Studio, bounded_plate
from app.cli.figures.shapes import ShapePair, beam, spiral
from app.cli.figures.sheet import name, new_sheet, plot_shares, show
from app.cli.figures.track import Tracked, tracked
from app.motion import Box
from engine.maps import HarmonicMap

TURN, GROWTH, NU = 2.6, 1.4, 0.5
TIME = 0.36
ZOOM = 0.17  # of the picture's longer side: half of what is shown larger
CAPTION = (
    "Scaling η, at t = 0.36. Where the keyframe enlarges the bar by more than √e, the unscaled η "
    "variant leaves the bounds on conformal distortion (upper row, and nearer in the second "
    "picture); scaled by ρ(t) it keeps them (lower row). Third: the keyframe. Right: k of the 100 "
    "worst points relative to the key."
)


def bar_wound_up(triangles: int) -> dict[str, Tracked]:
    """Return η and scaled η on the bar at rest, and wound up."""
    shape = beam(triangles)
    identity = HarmonicMap.identity(shape.domain.cage)
    wound = spiral(shape, turn=TURN, growth=GROWTH, nu=NU)
    return tracked(ShapePair(shape=shape, first=identity, second=wound), (ETA, SCALED_ETA))


def make(studio: Studio) -> Plate:
    """Draw the figure."""
    tracks = bar_wound_up(studio.triangles)
    sheet = new_sheet(11, 5.2)
    for row, track in zip(sheet.subplots(2, 4), tracks.values(), strict=True):
        frame = track.frame(TIME)
        box = box_of(frame.positions)
        worst = frame.positions[abs(frame.fzbar / frame.fz).argmax()]
        side = ZOOM * max(box.upper.real - box.lower.real, box.upper.imag - box.lower.imag)
        near = Box(worst - side * (1 + 1j), worst + side * (1 + 1j))
        show(row[0], studio.easel, track, TIME, box=box)
        show(row[1], studio.easel, track, TIME, box=near)
        show(row[2], studio.easel, track, 1.0)
        name(row[0], track.method.name)
        plot_shares(row[3], track.times, track.k_shares, "k", track.method.colour)
    return bounded_plate("Scaling η", CAPTION, sheet, tracks)

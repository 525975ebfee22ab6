"""Figure 4: a bar that is wound up and grows, with η and with scaled η."""

from app.motion import BoundingBox
from app.paper_figures.measure import MeasuredMotion, measure_motions
from app.paper_figures.methods import ETA, SCALED_ETA
from app.paper_figures.plots.paper_figure import FigureContext, PaperFigure, make_distortion_figure
from app.paper_figures.shape_renderer import bounds_of
from app.paper_figures.shapes import ShapePair, beam, spiral_map
from app.paper_figures.sheet import draw_frame, label_row, new_sheet, plot_shares
from app.texts import _
from engine.maps import HarmonicMap

TURN, GROWTH, NU = 2.6, 1.4, 0.5
TIME = 0.36
ZOOM = 0.17  # of the picture's longer side: half of the enlarged part
CAPTION = _(
    "Scaling η, at t = 0.36. Where the keyframe enlarges the bar by more than √e, the unscaled η "
    "variant leaves the bounds on conformal distortion (upper row, and nearer in the second "
    "picture); scaled by ρ(t) it keeps them (lower row). Third: the keyframe. Right: k of the 100 "
    "worst points relative to the key."
)


def make_wound_bar(triangles: int) -> dict[str, MeasuredMotion]:
    """Return the motion of the wound bar by η and by scaled η."""
    shape = beam(triangles)
    identity = HarmonicMap.identity(shape.domain.cage)
    wound = spiral_map(shape, turn=TURN, growth=GROWTH, nu=NU)
    return measure_motions(ShapePair(shape=shape, first=identity, second=wound), (ETA, SCALED_ETA))


def make_figure_4(studio: FigureContext) -> PaperFigure:
    tracks = make_wound_bar(studio.triangles)
    sheet = new_sheet(11, 5.2)
    for row, track in zip(sheet.subplots(2, 4), tracks.values(), strict=True):
        frame = track.frame(TIME)
        box = bounds_of(frame.positions)
        worst = frame.positions[abs(frame.fzbar / frame.fz).argmax()]
        side = ZOOM * max(box.upper.real - box.lower.real, box.upper.imag - box.lower.imag)
        near = BoundingBox(worst - side * (1 + 1j), worst + side * (1 + 1j))
        draw_frame(row[0], studio.renderer, track, TIME, box=box)
        draw_frame(row[1], studio.renderer, track, TIME, box=near)
        draw_frame(row[2], studio.renderer, track, 1.0)
        label_row(row[0], track.method.name)
        plot_shares(row[3], track.times, track.k_shares, "k", track.method.colour)
    return make_distortion_figure(_("Scaling η"), CAPTION, sheet, tracks)

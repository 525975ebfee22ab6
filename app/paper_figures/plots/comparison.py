"""Figures 5 to 7: methods in rows, with the distortion of their worst points."""

from collections.abc import Sequence
from dataclasses import replace

from app.motion import harmonic_coordinate_maps
from app.paper_figures.measure import measure_motions
from app.paper_figures.methods import ARAP, FFMP, METRIC, NU, SCALED_ETA, ComparedMethod
from app.paper_figures.plots.paper_figure import FigureContext, PaperFigure, make_distortion_figure
from app.paper_figures.shapes import ShapePair, bar_to_ring, beam, bend_points, letter_s
from app.paper_figures.sheet import draw_strip, new_sheet, plot_shares
from app.texts import _

TIMES = (0.0, 0.25, 0.5, 0.75, 1.0)
HORN_TURN, HORN_GROWTH = 2.4, 0.7  # of the bar in Figure 7, over its length


def make_figure_5(studio: FigureContext) -> PaperFigure:
    """Draw Figure 5: a letter S becomes a U."""
    caption = _(
        "S to U. Pictures and geometric distortion of our variants, ARAP and FFMP: k and τ of "
        "the 100 points of highest distortion, each relative to its keyframe. Our variants stay "
        "below the red line; the in-betweens of the other methods exceed it."
    )
    methods = (ARAP, FFMP, NU, SCALED_ETA, METRIC)
    return _compare(studio, letter_s(studio.triangles), methods, _("S to U"), caption)


def make_figure_6(studio: FigureContext) -> PaperFigure:
    """Draw Figure 6: a bar becomes a ring."""
    caption = _(
        "Bar to ring. Pictures and geometric distortion, as in Figure 5, of ARAP, FFMP and our "
        "variants that interpolate the direction of the stretch, which turns by a right angle here."
    )
    methods = (ARAP, FFMP, SCALED_ETA, METRIC)
    return _compare(studio, bar_to_ring(studio.triangles), methods, _("Bar to ring"), caption)


def make_figure_7(studio: FigureContext) -> PaperFigure:
    """Draw Figure 7: a bar bent to a horn, with a keyframe known only on its boundary."""
    caption = _(
        "Square bar. Both keyframes give only the positions of the outline's vertices. Harmonic "
        "coordinates make maps of these positions (Weber and Gotsman 2010, Section 10). "
        "Pictures and geometric distortion as in Figure 5."
    )
    shape = beam(studio.triangles)
    outline = shape.domain.outline
    middle = outline.mean()
    horn = bend_points(outline - middle, turn=HORN_TURN, growth=HORN_GROWTH)
    (first, second), _error = harmonic_coordinate_maps(outline, shape.domain.cage, [outline, horn])
    domain = replace(shape.domain, cage=first.cage)
    pair = ShapePair(
        shape=replace(shape, domain=domain), first=first, second=second, anchor=complex(middle)
    )
    return _compare(studio, pair, (ARAP, FFMP, METRIC), _("Harmonic coordinates"), caption)


def _compare(
    studio: FigureContext,
    pair: ShapePair,
    methods: Sequence[ComparedMethod],
    title: str,
    caption: str,
) -> PaperFigure:
    """Draw the pictures, and k and τ of the 100 worst points."""
    tracks = measure_motions(pair, methods)
    sheet = new_sheet(14, 2.1 * len(tracks))
    rows = sheet.subplots(len(tracks), len(TIMES) + 2, squeeze=False)
    draw_strip([row[:-2] for row in rows], studio.renderer, tracks, TIMES)
    for row, track in zip(rows, tracks.values(), strict=True):
        colour = track.method.colour
        plot_shares(row[-2], track.times, track.k_shares, "k", colour)
        plot_shares(row[-1], track.times, track.tau_shares, "τ", colour)
    return make_distortion_figure(title, caption, sheet, tracks)

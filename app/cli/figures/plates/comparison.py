"""Figures 5 to 7: methods in rows, with the distortion of their worst points."""

from collections.abc import Sequence

from app.cli.figures.methods import ComparedMethod
from app.cli.figures.plates.plate import BOUNDED, Plate, Studio, bounded_rows
from app.cli.figures.shapes import ShapePair
from app.cli.figures.sheet import as_png, new_sheet, plot_shares, show_strip
from app.cli.figures.track import Measured, Tracked

TIMES = (0.0, 0.25, 0.5, 0.75, 1.0)


def measure(pair: ShapePair, methods: Sequence[ComparedMethod]) -> tuple[Measured, ...]:
    """Measure methods on a pair."""
    return tuple(Tracked(pair, method).measured() for method in methods)


def compare(
    studio: Studio, pair: ShapePair, methods: Sequence[ComparedMethod], *, title: str, caption: str
) -> Plate:
    """Draw the pictures, and k and τ of the 100 worst points."""
    tracks = [Tracked(pair, method) for method in methods]
    sheet = new_sheet(14, 2.1 * len(tracks))
    widths = [*(1.0 for _ in TIMES), 1.0, 1.0]
    rows = sheet.subplots(
        len(tracks), len(widths), squeeze=False, gridspec_kw={"width_ratios": widths}
    )
    show_strip([row[: len(TIMES)] for row in rows], studio.easel, tracks, TIMES)
    for row, track in zip(rows, tracks, strict=True):
        colour = track.method.colour
        plot_shares(row[-2], track.times, track.k_shares, "k", colour)
        plot_shares(row[-1], track.times, track.tau_shares, "τ", colour)
    return Plate(
        title=title,
        caption=caption,
        picture=as_png(sheet),
        heads=BOUNDED,
        rows=bounded_rows(tuple(track.measured() for track in tracks)),
    )

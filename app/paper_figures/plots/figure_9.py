"""Figure 9: the time of a frame against the number of vertices, by every method."""

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

from app.paper_figures.methods import METHODS, METRIC, SIG13, ComparedMethod, prepare_variant
from app.paper_figures.plots.paper_figure import FigureContext, PaperFigure
from app.paper_figures.shapes import ShapePair, make_sample_pair
from app.paper_figures.sheet import INK, as_png, new_sheet, style_axes
from app.texts import _
from engine.interpolation import Variant
from engine.streaming import Positions, build_series, finish

SIZES = (1_000, 3_000, 10_000, 50_000, 100_000)
TIME = 0.4
ENOUGH = 0.02  # minimum seconds of a measurement
MOST = 200  # frames of a measurement
SERIES = _("metric, as a series")
CAPTION = _(
    "Time of one frame on one core of this machine's processor, against the number of vertices. "
    "Everything that does not depend on the time of the frame is prepared before. For a series, "
    "the motion of the metric variant in a segment is first written in few functions of time; "
    "Lissom plays in-betweens in this way."
)


@dataclass(frozen=True, slots=True, kw_only=True)
class FrameTimes:
    """Seconds per frame by method name, at a number of vertices."""

    vertices: int
    seconds: dict[str, float]

    def ratio(self, method: str) -> float:
        """Return the time of Chen et al. (2013) divided by a method's time."""
        return self.seconds[SIG13.name] / self.seconds[method]


def measure_frame_times(
    largest: int, methods: Sequence[ComparedMethod] = METHODS
) -> tuple[FrameTimes, ...]:
    """Time methods on the giraffe, with up to `largest` vertices."""
    timings = []
    for size in SIZES:
        if size > max(largest, SIZES[0]):
            break
        pair = make_sample_pair("giraffe", 0, 1, 2 * size)
        seconds = {}
        for method in methods:
            motion = method.prepare(pair)
            seconds[method.name] = _seconds(partial(motion, TIME))
        played = _played(pair)
        seconds[SERIES] = _seconds(partial(played, TIME))
        timings.append(FrameTimes(vertices=len(pair.shape.domain.mesh.vertices), seconds=seconds))
    return tuple(timings)


def make_figure_9(studio: FigureContext) -> PaperFigure:
    timings = measure_frame_times(studio.largest)
    vertices = [timing.vertices for timing in timings]
    sheet = new_sheet(9, 5)
    axes = sheet.subplots()
    colours = {method.name: method.colour for method in METHODS} | {SERIES: METRIC.colour}
    for named, colour in colours.items():
        seconds = [timing.seconds[named] for timing in timings]
        style = "--" if named == SERIES else "-"
        axes.loglog(vertices, seconds, style, marker="o", markersize=4, color=colour, label=named)
    axes.set_xlabel("vertices", color=INK)
    axes.set_ylabel(_("seconds per frame"), color=INK)
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    style_axes(axes)
    return PaperFigure(
        title=_("Running times"),
        caption=CAPTION,
        picture=as_png(sheet),
        column_names=(
            "vertices",
            *(f"{named}, ms" for named in colours),
            "Chen et al. / metric",
            "Chen et al. / series",
        ),
        rows=tuple(
            (
                f"{timing.vertices:,}",
                *(f"{1e3 * timing.seconds[named]:.3g}" for named in colours),
                f"{timing.ratio(METRIC.name):,.0f}",
                f"{timing.ratio(SERIES):,.0f}",
            )
            for timing in timings
        ),
    )


def _played(pair: ShapePair) -> Callable[[float], object]:
    """Return a function that plays the metric variant's series."""
    prepared = prepare_variant(pair, Variant.METRIC)
    return finish(build_series(Positions.of(prepared.segments[0], prepared.sampled_domain))).values


def _seconds(frame: Callable[[], object]) -> float:
    """Return the smallest time of a frame, on one core."""
    least, spent = float("inf"), 0.0
    for _run in range(MOST):
        start = time.process_time()
        frame()
        taken = time.process_time() - start
        least, spent = min(least, taken), spent + taken
        if spent > ENOUGH:
            break
    return least

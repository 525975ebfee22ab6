"""The figures of the paper by number."""

from app.paper_figures.plots import (
    comparison,
    figure_1,
    figure_3,
    figure_4,
    figure_8,
    figure_9,
    figure_10,
    figure_11,
)

MAKERS = {
    1: figure_1.make_figure_1,
    3: figure_3.make_figure_3,
    4: figure_4.make_figure_4,
    5: comparison.make_figure_5,
    6: comparison.make_figure_6,
    7: comparison.make_figure_7,
    8: figure_8.make_figure_8,
    9: figure_9.make_figure_9,
    10: figure_10.make_figure_10,
    11: figure_11.make_figure_11,
}

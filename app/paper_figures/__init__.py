"""The paper's figures, made with this project's own drawings.

In: numbers of figures, and a `FigureContext`.
Out: pictures, and one page with captions and measurements.
Imports: `app.render`, `app.reports`.
"""

from app.paper_figures.page import render_page as render_page
from app.paper_figures.plots.paper_figure import (
    FigureContext as FigureContext,
    PaperFigure as PaperFigure,
)
from app.paper_figures.plots.table import MAKERS as MAKERS
from app.paper_figures.shape_renderer import ShapeRenderer as ShapeRenderer
from app.paper_figures.sheet import require_matplotlib as require_matplotlib

"""The paper's figures, made with this project's own drawings.

In: numbers of figures, and a `FigureContext`.
Out: pictures, and one page with captions and measurements.
Imports: `app.render`, `app.reports`, `app.storage`, `engine`.
"""

from app.cli.figures.page import render_page as render_page
from app.cli.figures.plots import (
    MAKERS as MAKERS,
    FigureContext as FigureContext,
    PaperFigure as PaperFigure,
)
from app.cli.figures.shape_renderer import ShapeRenderer as ShapeRenderer
from app.cli.figures.sheet import require_matplotlib as require_matplotlib

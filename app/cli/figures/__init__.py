"""The paper's figures, made anew with this project's own drawings.

In: numbers of figures.
Out: pictures, and one page with captions and what was measured.
Imports: `app.render`, `app.reports`, `app.storage`, `engine`.
"""

from app.cli.figures.make import make_figures
from app.cli.figures.plates import MAKERS, Plate

__all__ = ["MAKERS", "Plate", "make_figures"]

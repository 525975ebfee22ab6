"""The paper's figures, made anew with this project's own drawings.

In: numbers of figures, and a studio.
Out: pictures, and one page with captions and what was measured.
Imports: `app.render`, `app.reports`, `app.storage`, `engine`.
"""

from app.cli.figures.easel import Easel
from app.cli.figures.page import lay_out
from app.cli.figures.plates import MAKERS, Plate, Studio
from app.cli.figures.sheet import require_matplotlib

__all__ = ["MAKERS", "Easel", "Plate", "Studio", "lay_out", "require_matplotlib"]

"""The paper's figures, made anew with this project's own drawings.

In: numbers of figures, and a studio.
Out: pictures, and one page with captions and what was measured.
Imports: `app.render`, `app.reports`, `app.storage`, `engine`.
"""

from app.cli.figures.easel import Easel as Easel
from app.cli.figures.page import lay_out as lay_out
from app.cli.figures.plates import MAKERS as MAKERS, Plate as Plate, Studio as Studio
from app.cli.figures.sheet import require_matplotlib as require_matplotlib

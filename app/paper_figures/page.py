"""A self-contained page with all figures."""

import base64
from collections.abc import Mapping
from html import escape

from app.paper_figures.plots.paper_figure import PaperFigure
from app.texts import _

STYLE = """
body { font: 16px/1.5 system-ui, sans-serif; color: #2b2f38; background: #fff;
  max-width: 1280px; margin: 2rem auto; padding: 0 1rem }
figure { margin: 3rem 0 }
img { max-width: 100%; height: auto }
figcaption { max-width: 60rem }
table { border-collapse: collapse; margin-top: .8rem; font-size: .9rem }
th, td { padding: .25rem .9rem .25rem 0; text-align: right; border-bottom: 1px solid #e0e2e8;
  font-variant-numeric: tabular-nums }
th:first-child, td:first-child { text-align: left }
"""
INTRODUCTION = _(
    "The figures of <cite>Bounded Distortion Harmonic Shape Interpolation</cite> (Chien, Chen "
    "and Weber, SIGGRAPH 2016), redrawn with Lissom's own drawings. In a table, a number for a "
    "key is relative to the larger of both keyframes. The tables show k and τ − 1 of the 100 "
    "points of highest distortion, each relative to its own keyframe. They then show the "
    "largest values of all points, and the least area over time. Bounded in-betweens do not "
    "exceed 1."
)


def render_page(plates: Mapping[int, PaperFigure]) -> str:
    figures = "\n".join(_figure(number, plate) for number, plate in plates.items())
    return (
        '<!doctype html>\n<html lang="en"><head><meta charset="utf-8">\n'
        f"<title>{_('Figures')} – Lissom</title>\n"
        f"<style>{STYLE}</style></head>\n<body>\n<h1>{_('Figures')}</h1>\n<p>{INTRODUCTION}</p>\n"
        f"{figures}\n</body></html>\n"
    )


def _figure(number: int, plate: PaperFigure) -> str:
    name = _("Figure {number}").format(number=number)
    picture = base64.b64encode(plate.picture).decode()
    head = "".join(f"<th>{escape(word)}</th>" for word in plate.column_names)
    rows = "".join(
        "<tr>" + "".join(f"<td>{escape(word)}</td>" for word in row) + "</tr>\n"
        for row in plate.rows
    )
    return (
        f'<figure id="figure-{number}">\n<h2>{name}: {escape(plate.title)}</h2>\n'
        f'<img alt="{name}" src="data:image/png;base64,{picture}">\n'
        f"<figcaption>{escape(plate.caption)}\n<table><tr>{head}</tr>\n{rows}</table>\n"
        "</figcaption></figure>"
    )

"""The figures, one module each; figures that compare alike share one.

In: a `FigureContext`.
Out: `PaperFigure`s: a picture, a caption, and numbers.
Imports: `app.paper_figures` without its page.
"""

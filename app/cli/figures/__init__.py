"""The paper's figures, made with this project's own drawings.

In: numbers of figures, and a `FigureContext`.
Out: pictures, and one page with captions and measurements.
Imports: `app.render`, `app.reports`, `app.storage`, `engine`.
"""

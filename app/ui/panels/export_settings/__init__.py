"""Parts of the export panel: sizes, options of formats, preview.

In: the settings of an export.
Out: changed settings.
Imports: `app.ui.style`.
"""

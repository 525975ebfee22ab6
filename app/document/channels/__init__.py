"""Channels: all that is keyed, and how time passes between keys. The kinds are a table, `kinds`.

In: values at frames.
Out: keys, easings, cycles, tracks and springs, and what a kind does with its keys.
Imports: `app.document.checks`.
"""

"""Lissom: pose a drawing, set keyframes, get in-betweens that never fold.

In: pictures, projects, and a person's hand.
Out: projects, frames, and a window.
Imports: `engine`.
"""

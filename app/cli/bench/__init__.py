"""Measurements behind the figures of the README, one module for each part of Lissom.

In: nothing.
Out: tables of figures, measured on this machine.
Imports: every part that it measures.
"""

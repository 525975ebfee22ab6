"""Measurements behind the figures of the README, one module for each part of Lissom."""

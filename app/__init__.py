"""Lissom: pose a drawing, set keyframes, get in-betweens that never fold."""

"""Harmonic shape interpolation: pure numerics, free of files, windows and global state."""

"""Motion presets on drawings: joints become handles, and times of a motion become keys.

In: a layer, the places of its joints, and a motion preset.
Out: the layer with its keys, and its target errors.
Imports: `app.document`, and the solver beside it.
"""

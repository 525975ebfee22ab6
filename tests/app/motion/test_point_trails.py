"""Trails of points: what a kept result depends on stays alive with it."""

from dataclasses import replace

import numpy as np
from documents import CENTRE, disc_document, random_pose

from app.document import TangentMode, clip_of, key_commands
from app.document.commands import handle_commands
from app.motion.inbetweens.segment_keys import segment_poses
from app.motion.tracing.point_trails import PointTrails


def test_trail_keeps_the_poses_of_its_segments_pins():
    # Results are known by the ids of maps, which another map may get once a pose is gone.
    document = disc_document()
    for place in (CENTRE - 20, CENTRE + 20):
        document = handle_commands.add_handle(0, place)(document)
    rng = np.random.default_rng(1)
    one, other, last = (random_pose(rng, document) for _ in range(3))
    # Handle 0 stays from the first key to the second, and moves on smoothly from there.
    other = replace(other, targets={**other.targets, 0: one.targets[0]})
    for frame, pose in ((5, one), (10, other), (20, last)):
        document = key_commands.insert_key(0, frame, pose)(document)
    (layer,) = document.layers
    keys = tuple(replace(key, tangent_mode=TangentMode.CORNER) for key in layer.keys)
    clip = clip_of(document.with_layer(replace(layer, keys=keys)), 0)
    poses = PointTrails(clip, np.array([CENTRE])).at(15).poses
    assert set(poses) == {one, other, last} == set(segment_poses(clip, 2))


def test_trails_of_a_rebuilt_domain_are_at_their_own_points():
    # A domain that was built anew may have the same outline.
    document, points = disc_document(), np.array([CENTRE])
    earlier = PointTrails(clip_of(document, 0), points)
    earlier.at(0)
    layer = document.layers[0]
    rebuilt = document.with_layer(replace(layer, domain=replace(layer.domain)))
    pose = random_pose(np.random.default_rng(1), rebuilt)
    clip = clip_of(key_commands.insert_key(0, 5, pose)(rebuilt), 0)
    positions = PointTrails(clip, points, earlier=earlier).at(5).positions
    np.testing.assert_allclose(positions, clip.layer.map_of(pose)(points), atol=1e-6)

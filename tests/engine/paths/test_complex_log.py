import numpy as np
import pytest
from interpolation_shapes import inner_points, letter_l, spiral
from messages import says
from numpy.testing import assert_allclose, assert_array_equal

from engine.errors import EngineError
from engine.paths.complex_log import TURN_COUNT, continue_logarithm, root_sheets
from engine.paths.integration_paths import lay_paths
from engine.paths.path_network import Network, scattered_network


def paths_of(shape, seed=0):
    outline, cage = shape
    points = np.concatenate([inner_points(outline, 80, seed), outline])
    return lay_paths(scattered_network(outline, points, points[:1]), outline, cage)


@pytest.mark.parametrize("rate", [1.0, 30.0, 400.0])
def test_the_logarithm_is_continuous_however_far_it_turns(rate):
    # At the largest rate f_z turns by several radians along one step.
    paths = paths_of(letter_l())

    def function(z):
        return np.exp(1j * rate * z / 10 + 0.3)

    fz = function(paths.nodes)
    logarithm = continue_logarithm(fz, np.full(len(fz), 1j * rate / 10), paths, function)
    exact = 1j * rate * paths.nodes / 10
    assert_allclose(logarithm - logarithm[0], exact - exact[0], rtol=0, atol=1e-10)
    assert logarithm[0] == pytest.approx(np.log(fz[0]))


@pytest.mark.parametrize("turns", [1, 2, 12])
def test_whole_turns_within_a_step_are_counted(turns):
    # Along a step f_z turns by whole turns and half a radian: its ratio shows the latter only.
    nodes = np.array([0.5 + 0.5j, 0.52 + 0.5j])
    network = Network(nodes=nodes, parents=np.array([0, 0]), places=np.array([1]))
    paths = lay_paths(network, *letter_l())
    (step,) = paths.steps[1:]
    rate = 1j * (2 * np.pi * turns + 0.5) / step

    def function(z):
        return np.exp(rate * (z - nodes[0]))

    fz = function(paths.nodes)
    logarithm = continue_logarithm(fz, np.full(len(fz), rate), paths, function)
    assert_allclose(logarithm[1] - logarithm[0], rate * step, rtol=0, atol=1e-10)


def test_in_a_spiral_the_argument_follows_the_arm():
    # z winds around 0 with the arm, where the principal value would jump.
    paths = paths_of(spiral(), seed=3)
    logarithm = continue_logarithm(paths.nodes, 1 / paths.nodes, paths, lambda z: z)
    assert np.ptp(logarithm.imag) > 1.5 * np.pi
    assert_allclose(np.exp(logarithm), paths.nodes, rtol=1e-13, atol=0)
    steps = (logarithm - logarithm[paths.tree.parent]).imag
    assert np.abs(steps).max() < 1


def test_a_zero_on_a_path_is_refused():
    paths = paths_of(letter_l())
    at = (paths.nodes[5] + paths.nodes[paths.tree.parent[5]]) / 2
    with pytest.raises(EngineError, match="vanishes"):
        continue_logarithm(paths.nodes - at, 1 / (paths.nodes - at), paths, lambda z: z - at)


def test_neighbouring_keyframes_take_the_shorter_way():
    angles = np.array([3.0, -3.0, -0.5, 2.5, -1.0])
    fz = 2 * np.exp(1j * angles)
    arguments = angles + 2 * np.pi * root_sheets(fz)
    assert arguments[0] == angles[0]
    assert np.all(np.abs(np.diff(arguments)) <= np.pi)


def test_turns_are_added_from_their_interval_on():
    fz = np.exp(1j * np.array([0.0, 1.0, 2.0, 3.0]))
    assert_array_equal(root_sheets(fz, [0, 2, -1]), [0, 0, 2, 1])


@pytest.mark.parametrize(
    "turns", [[2**31, 0], [-(2**40), 0], [600_000, 600_000], np.array([2**63, 0], dtype=np.uint64)]
)
def test_more_turns_than_an_angle_has_digits_for_are_refused(turns):
    fz = np.ones(3, dtype=complex)
    assert_array_equal(root_sheets(fz, [1_000_000, -2_000_000]), [0, 1_000_000, -1_000_000])
    with pytest.raises(EngineError, match="more than 1,000,000 whole turns"):
        root_sheets(fz, turns)


@pytest.mark.parametrize("turns", [[1], [1.0, 0.0], [[0, 0]]])
def test_turns_of_the_wrong_kind_are_refused(turns):
    with pytest.raises(EngineError, match=says(TURN_COUNT, count=2)):
        root_sheets(np.ones(3, dtype=complex), turns)

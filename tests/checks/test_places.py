import numpy as np

from timemap_cli.checks.places import Ends, MovedPlace, confirmed, moved_places


def ends(*groups):
    """Each group is (number of ends, x, y, node, distance)."""
    x, y, node, distance = (
        np.concatenate([np.full(group[0], group[i]) for group in groups]) for i in (1, 2, 3, 4)
    )
    return Ends(x.astype(float), y.astype(float), node.astype(np.int64), distance.astype(float))


THREE_SEE_IT = [(6, 2.1, 3.1, node, 0.15) for node in (5, 6, 7)]


def test_a_surface_that_three_nodes_see_off_is_a_place():
    (place,) = moved_places(ends(*THREE_SEE_IT, (5, 2.1, 3.1, 7, 0.25)), 0.08, nodes=9)
    assert (round(place.x, 6), round(place.y, 6), place.ends) == (2.1, 3.1, 23)
    assert place.nodes == (7, 5, 6)  # the one with most ends first
    assert place.distance == 0.15  # of 23 the twelfth


def test_the_last_bit_of_a_distance_of_whole_centimetres_decides_nothing():
    for distance in (np.nextafter(0.08, 0), 0.08, np.nextafter(0.08, 1)):
        seen = ends(*((*group[:4], distance) for group in THREE_SEE_IT))
        assert moved_places(seen, 0.08, nodes=9) == []


def test_what_two_nodes_see_is_no_place_unless_there_are_no_more():
    two = ends(*(group for group in THREE_SEE_IT if group[3] != 7), (6, 2.1, 3.1, 6, 0.15))
    assert moved_places(two, 0.08, nodes=9) == []
    assert len(moved_places(two, 0.08, nodes=2)) == 1


def test_few_ends_among_many_that_stayed_are_the_edges_of_a_wall():
    assert moved_places(ends(*THREE_SEE_IT, (40, 2.1, 3.1, 5, 0.01)), 0.08, nodes=9) == []


def test_a_thing_across_the_borders_of_cells_is_one_place():
    spread = [
        (4, 2.0 + dx, 3.0 + dy, node, 0.2)
        for node in (1, 2, 3)
        for dx in (-0.05, 0.05)
        for dy in (-0.05, 0.05)
    ]
    (place,) = moved_places(ends(*spread), 0.08, nodes=9)
    assert place.ends == 48


def test_places_apart_are_told_the_larger_first():
    far = [(7, 8.1, 3.1, node, 0.15) for node in (1, 2, 3)]
    assert [place.ends for place in moved_places(ends(*THREE_SEE_IT, *far), 0.08, nodes=9)] == [21, 18]


def place_of(ends, x):
    return MovedPlace(x, 3.1, ends, (1, 2, 3), 0.15)


def test_a_few_ends_at_one_level_are_noise_and_at_several_levels_a_thing():
    assert confirmed([[place_of(11, 2.1)], [], []]) == [[], [], []]
    levels = [[place_of(11, 2.1)], [place_of(9, 2.3)], []]
    assert confirmed(levels) == levels


def test_many_ends_at_one_level_are_a_thing():
    levels = [[], [], [place_of(16, 2.1)]]
    assert confirmed(levels) == levels


def test_places_of_two_levels_apart_do_not_confirm_each_other():
    assert confirmed([[place_of(11, 2.1)], [place_of(9, 3.2)]]) == [[], []]


def test_nothing_to_compare_is_no_place():
    assert moved_places(ends((0, 0, 0, 0, 0)), 0.08, nodes=3) == []

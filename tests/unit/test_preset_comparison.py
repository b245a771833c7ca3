"""Whether a scene is still what presets say."""

from blackhole_gl.scene import Scene, presets


def left(scene, *names):
    layers = [presets.read(name) for name in names]
    return [presets.departures(scene, layers, place) for place in range(len(layers))]


def test_a_scene_just_made_is_what_its_presets_say():
    for names in (["kerr"], ["thin_disk", "particle_storm"], ["kerr_0998_85", "smooth"]):
        assert left(presets.load(names), *names) == [()] * len(names)


def test_a_changed_value_is_told_of_the_preset_that_says_it():
    scene = presets.load(["kerr", "smooth"]).with_values({"hole.spin": 0.0, "post.bloom": True, "sky.brightness": 3.0})
    assert left(scene, "kerr", "smooth") == [("hole.spin",), ("post.bloom",)], "of the sky neither says anything"


def test_what_a_later_layer_sets_is_no_departure_from_an_earlier_one(tmp_path):
    file = tmp_path / "slow.toml"
    file.write_text("[hole]\nspin = 0.1\n")
    scene = presets.load(["kerr", file])
    assert left(scene, "kerr", file) == [(), ()]
    assert left(scene.with_values({"hole.spin": 0.2}), "kerr", file) == [(), ("hole.spin",)]


def test_two_scenes_differ_in_any_value():
    scene = presets.load(["luminet_1979"])
    assert presets.differing(scene, scene) == ()
    assert presets.differing(scene.with_values({"post.exposure": -1.0}), scene) == ("post.exposure",)
    assert presets.differing(Scene(), Scene().with_values({"playback.rate": 1.0})) == ("playback.rate",)

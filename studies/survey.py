"""The survey: every sensible method in every scene of the chart."""

from __future__ import annotations

from collections.abc import Callable

from blackhole_gl import listed_rays
from blackhole_gl.listed_rays import TracedRays
from blackhole_gl.measure.methods import Combination, exact_for, sensible, worth_refining
from blackhole_gl.measure.scenes import ChartScene, chart_scenes
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import catalogue
from studies.measure import FULL, QUICK, Row, measure
from studies.work import Kept, key_of


def survey(renderer: Renderer, kept: Kept, quick: bool = False, progress: Callable[[float, str], None] | None = None) -> list[Row]:
    """All rows, scene by scene; what `kept` holds already is not measured again.

    Args:
        progress: called with the share done (0…1) and what is being measured.
    """
    timings = QUICK if quick else FULL
    work = [
        (chart_scene, method)
        for chart_scene in chart_scenes(quick)
        for method in (*sensible(chart_scene.scene, chart_scene.whole), *worth_refining(chart_scene.scene, quick))
    ]
    twins: dict[tuple[str, str, tuple], TracedRays | None] = {}
    rows: list[Row] = []
    for done, (chart_scene, method) in enumerate(work):
        if progress is not None:
            progress(done / len(work), f"{chart_scene.name}: {method.name}")
        settings = method.settings(quick)
        key = key_of(chart_scene, method, settings, timings)
        group = kept.get(key)
        if group is None:
            which = (chart_scene.name, method.model, method.changes)
            if which not in twins:
                twins[which] = own_twin(chart_scene, method)
            group = measure(renderer, chart_scene, method, settings, timings, twins[which])
            kept.put(key, group)
        rows += group
    return rows


def own_twin(chart_scene: ChartScene, method: Combination) -> TracedRays | None:
    """The rays by the method's own float64 twin; None where the model is exact for the scene, so that its twin is the truth itself."""
    if exact_for(catalogue.plug_ins("ray_model")[method.model], chart_scene.scene):
        return None
    scene = method.applied(chart_scene.scene, method.settings()[0])
    try:
        return listed_rays.trace_by_reference(scene, chart_scene.rays)
    except ValueError:  # a model without a twin
        return listed_rays.unknown(len(chart_scene.rays))

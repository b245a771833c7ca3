"""What plug-ins say of themselves in their headers, beside what people read and their parameters: a frozen record for each slot.

Annotations are the schema: `headers.record` checks a header's entries against them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Literal

from .headers import Between

Time = Literal["cartesian", "mino", "field"]
"""What a differential model's step is a step of: σ of Cartesian space (r_s) round a hole, Mino time (an angle), or σ in a field without a hole (r_s)."""

ALL_TIMES: tuple[Time, ...] = ("cartesian", "mino", "field")


@dataclass(frozen=True)
class RayModelTraits:
    """A ray model.

    Attributes:
        kind: ``closed`` goes from pixel to hits at once, ``differential`` is marched.
        space_time: that of the observer.
        spins: whether the hole's spin means anything to it.
        exact: whether it solves its space-time; else it is art, or an approximation.
        marches_in: of a differential model; None for closed ones.
        step_control: the one that suits it best; None for closed models.
        tells_paths: whether a closed model also says where in space its rays run, so that they can meet things; marched ones do.
        second_order: whether its forces depend on places alone.
        march_bound: r_s beyond which its outward rays may be finished in closed form; None: where the plan does for all.
        field: whether it bends rays in flat space by a field within a sphere, ``rays.field_radius``: then there is no hole.
        harder_with, milder_with: of a field, parameters that ask for shorter steps the farther they are from 0, and the smaller they are.
        crosses_horizon: whether a camera that falls may look out from inside the horizon: with CAMERA_FALLS set its rays are regular there.
        tells_time: whether it also says how long light has been under way, for ``rays.light_travel``.
        tilted_disk: whether all the crossings that it finds are those of common/disk_plane.glsl, so that the disk may be tilted.
    """

    kind: Literal["closed", "differential"]
    space_time: Literal["flat", "schwarzschild", "kerr"]
    spins: bool
    exact: bool
    marches_in: Time | None = None
    step_control: str | None = None
    tells_paths: bool = False
    second_order: bool = False
    march_bound: Annotated[float, Between(1.0, 1e4)] | None = None
    field: bool = False
    harder_with: tuple[str, ...] = ()
    milder_with: tuple[str, ...] = ()
    tilted_disk: bool = False
    tells_time: bool = False
    crosses_horizon: bool = False

    @property
    def meets_things(self) -> bool:
        """Whether its rays can meet more than the disk's plane."""
        return self.kind == "differential" or self.tells_paths

    def __post_init__(self) -> None:
        for name in ("marches_in", "step_control"):
            stated = getattr(self, name) is not None
            if self.kind == "differential" and not stated:
                raise ValueError(f"the header lacks {name!r}, which a model of kind differential has to say")
            if self.kind == "closed" and stated:
                raise ValueError(f"{name}: a model of kind closed takes no steps and has no such entry")


@dataclass(frozen=True)
class IntegratorTraits:
    """An integrator.

    Attributes:
        order: of its error in the step.
        evaluations: of the right-hand side in one step.
        pair_evaluations: the same for ``integrator_pair``, which estimates its error too; None where it has none.
        second_order: whether it asks for forces that depend on places alone.
        fits: the models it is for, by what they march in.
    """

    order: Annotated[int, Between(1, 20)]
    evaluations: Annotated[int, Between(1, 100)]
    pair_evaluations: Annotated[int, Between(1, 100)] | None = None
    second_order: bool = False
    fits: tuple[Time, ...] = ALL_TIMES


@dataclass(frozen=True)
class StepControlTraits:
    """A step control.

    Attributes:
        adapts: whether it tries steps and judges them, and so finds their length by itself.
        needs_pair: whether it judges by the integrator's own error estimate.
        integrator_steps: steps of the integrator in one step of its own.
        shortest: mean length of its steps on a ray's whole way, of the plain step.
        fits: the models it is for, by what they march in.
    """

    adapts: bool = False
    needs_pair: bool = False
    integrator_steps: Annotated[int, Between(1, 100)] = 1
    shortest: Annotated[float, Between(1e-3, 1.0)] = 1.0
    fits: tuple[Time, ...] = ALL_TIMES


@dataclass(frozen=True)
class DiskLayerTraits:
    """A disk layer.

    Attributes:
        enabled: whether it is on in a scene that does not say.
        moves: whether it looks otherwise at another time.
        acts_on_light: whether it makes the same matter brighter or darker than physics does; its switch is marked so.
    """

    enabled: bool = False
    moves: bool = True
    acts_on_light: bool = False


@dataclass(frozen=True)
class MetTraits:
    """What kinds of things and of media say alike.

    Attributes:
        reach: parameters the sum of whose sizes no part of an instance is farther from its centre than, in r_s.
        centre: parameters that are the place of the centre, three; none where it is the hole. A kind that moves has a centre without saying so.
        moves: whether instances have the parameters of `motion` too, a place at rest or an orbit.
        round: of a kind that moves, whether a ray meets it alike however it is turned about its centre: it is a ball, of the radius that `reach` says.
        increasing: parameters none of which may be larger than the one after it.
    """

    reach: tuple[str, ...]
    centre: tuple[str, ...] = ()
    moves: bool = False
    round: bool = False
    increasing: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if len(self.centre) not in (0, 3):
            raise ValueError(f"centre: got {len(self.centre)} names; allowed are three, or none for the hole")
        if self.centre and self.moves:
            raise ValueError("centre: a kind that moves has a centre already; allowed is one of centre and moves")


@dataclass(frozen=True)
class ThingTraits(MetTraits):
    """A kind of thing that rays may meet.

    Attributes:
        opaque: whether nothing shines through it.
        surface: whether instances have the parameters of a surface too, which say how it looks.
        shines: whether instances have the parameters of a lamp too, and light falls from them on surfaces.
        meets: what it tells of where it is: how far any place is from it, or where a straight piece of a ray's way meets it.
        tells_apart: whether it tells, too, that a way misses it which strays from a straight piece by much: of kinds that fill little of their balls.
    """

    opaque: bool = True
    surface: bool = False
    shines: bool = False
    meets: Literal["distance", "crossing"] = "distance"
    tells_apart: bool = False


@dataclass(frozen=True)
class MediumTraits(MetTraits):
    """A kind of medium that rays may go through.

    Attributes:
        bolometric: whether its light is that of all frequencies; else of the one that is seen.
        changes: whether its light changes with time on a ray that stays the same.
        soft: whether next to nothing of it is left at its surface, so that no edge is seen there.
        phenomenological: whether it is made for its looks and solves no equations of matter; its parameters are then told as art.
        thickness: of a disk with depth, the parameter that is half its thickness; an instance's 0 stands for ``disk.thickness``. Empty for others.
        parts: parameters what serves which is compiled only where an instance has one above 0: as the switch ``MEDIUM_<KIND>_<PARAMETER>``.
    """

    bolometric: bool = True
    changes: bool = False
    soft: bool = False
    phenomenological: bool = False
    thickness: str = ""
    parts: tuple[str, ...] = ()


@dataclass(frozen=True)
class SkyTraits:
    """A sky.

    Attributes:
        stars: how many points of light it may have in a pixel, which are drawn apart where a coarse picture would smear them (shaders/shade_sky.frag).
        changes: whether it is another at another time; else it is kept while camera and scene rest.
    """

    stars: Annotated[int, Between(0, 16)] = 0
    changes: bool = False


Traits = RayModelTraits | IntegratorTraits | StepControlTraits | DiskLayerTraits | ThingTraits | MediumTraits | SkyTraits

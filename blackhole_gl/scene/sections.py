"""The fixed sections of a scene, as frozen records whose fields carry their range, unit and meaning.

Lengths are in Schwarzschild radii (r_s = 2GM/c² = 1), times in r_s/c, angles in degrees where the key ends in ``_deg``.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from dataclasses import fields as record_fields
from types import MappingProxyType
from typing import Any, TypeVar

_Number = TypeVar("_Number", int, float)


def number(
    default: _Number,
    low: float,
    high: float,
    unit: str = "",
    help: str = "",
    *,
    physical: float | None = None,
    allow_infinity: bool = False,
    art: bool = False,
) -> _Number:
    """A record field that holds a number in the closed range low…high."""
    kind = "int" if isinstance(default, int) else "float"
    facts = dict(kind=kind, low=low, high=high, unit=unit, help=help, physical=physical, allow_infinity=allow_infinity, art=art)
    return field(default=default, metadata=facts)


def switch(default: bool, help: str = "", *, physical: bool | None = None):
    """A record field that is on or off."""
    return field(default=default, metadata=dict(kind="switch", help=help, physical=physical))


def choice(default: str, options: tuple[str, ...] | str, help: str = "", *, physical: str | None = None, art: bool = False):
    """A record field that names one of `options`; a string names the catalogue slot whose plug-ins are the options.

    With the default ``auto``, that word is an option too: the plan chooses.
    """
    return field(default=default, metadata=dict(kind="choice", options=options, help=help, physical=physical, art=art))


@dataclass(frozen=True)
class Hole:
    """The black hole."""

    spin: float = number(0.0, -0.9999, 0.9999, "a*", "Angular momentum J c/(G M²). Negative turns clockwise seen from +z.")
    gravity_strength: float = number(
        1.0, 0.1, 10.0, "×", "Multiplies the bending of light in the marched models; 1 is physics, all else is art.", physical=1.0, art=True,
    )
    horizon_size: float = number(
        1.0, 0.01, 1.0, "r_s", "Radius at which the marched models take a ray as captured; 1 is the Schwarzschild horizon.", physical=1.0, art=True,
    )


@dataclass(frozen=True)
class Source:
    """The real object that the scene stands for: what angles on the sky are worked out from. Light's ways do not depend on it."""

    real: bool = switch(False, "The scene stands for a real object: angles on the sky are told, over the picture and by a scale bar where labels are on.")
    mass_suns: float = number(6.5e9, 0.1, 1e12, "M☉", "Mass of the hole. M87*: 6.5e9; Sagittarius A*: 4.15e6.")
    distance_pc: float = number(16.8e6, 1e-3, 1e11, "pc", "Distance from the Earth, in parsecs. M87*: 1.68e7; Sagittarius A*: 8178.")


@dataclass(frozen=True)
class Camera:
    """The observer and its picture."""

    distance: float = number(
        20.0, 0.1, 1e4, "r_s",
        "Boyer–Lindquist (areal) radius of the camera, above the horizon: 1 without spin, down to 0.5 with; of one that falls, inside of it, too. inf is a "
        "far observer with parallel rays.",
        allow_infinity=True,
    )
    inclination_deg: float = number(80.0, 0.0, 180.0, "°", "Angle from the spin axis: 0 above the north pole, 90 in the disk's plane.")
    azimuth_deg: float = number(0.0, -360.0, 360.0, "°", "Azimuth of the camera about the spin axis, counter-clockwise seen from +z.")
    yaw_deg: float = number(0.0, -180.0, 180.0, "°", "Turns the view to the right, away from the hole.")
    pitch_deg: float = number(0.0, -90.0, 90.0, "°", "Turns the view up, away from the hole.")
    roll_deg: float = number(0.0, -180.0, 180.0, "°", "Turns the camera clockwise about its line of sight.")
    fov_deg: float = number(45.0, 1.0, 150.0, "°", "Vertical angle of view.")
    field_m: float = number(30.0, 0.1, 1e4, "M", "Height of the picture when the camera is infinitely far.")
    projection: str = choice(
        "perspective", ("perspective", "equirectangular", "stereo", "cube", "dome"),
        "How directions lie in the picture: in perspective; all round, with the longitude across and the latitude up (360°, twice as wide as high), or two "
        "such over one another, for the left eye and the right (as wide as high); on the six faces of a cube side by side (right, left, up, down, front, "
        "back); or the half of the world over a planetarium's dome, as a disc (fisheye).",
    )
    eye_separation: float = number(
        0.2, 0.0, 10.0, "r_s",
        "Between the eyes of stereo, each of which stands aside of the camera in every direction that it looks: in Boyer–Lindquist coordinates, r_s = 1, which "
        "near a hole is not what a ruler measures there.",
    )
    dome_tilt_deg: float = number(
        0.0, 0.0, 90.0, "°", "How far the dome's zenith, the middle of its picture, is above what the camera looks at: at 90 that stands on the rim, in front.",
    )
    observer: str = choice(
        "static", ("static", "zamo", "circular", "rain", "fall"),
        "How the camera moves: at rest; with zero angular momentum (ZAMO), dragged round by a spinning hole; on a circular orbit, with the disk's matter; or "
        "falling, like rain from rest at infinity, or from rest at camera.fall_from. In the ergosphere nothing can rest: there the static observer gives "
        "way to the ZAMO.",
    )
    fall_from: float = number(30.0, 0.5001, 1e4, "r_s", "Where the observer that falls was at rest; at least the camera's distance.")
    velocity_right: float = number(0.0, -0.99, 0.99, "c", "A velocity of the camera's own against that observer: to the right of one who looks at the hole.")
    velocity_up: float = number(0.0, -0.99, 0.99, "c", "The same upwards. It does not turn with the view.")
    velocity_forward: float = number(0.0, -0.99, 0.99, "c", "The same towards the hole. All three together are slower than light.")
    aberration: bool = switch(True, "The camera's motion shifts where things are seen, towards where it goes.", physical=True)
    doppler_colour: bool = switch(True, "The camera's motion shifts colours: blue ahead, red behind.", physical=True)
    beaming: bool = switch(True, "The camera's motion brightens what is ahead, as the fourth power of the shift, and dims what is behind.", physical=True)


@dataclass(frozen=True)
class Rays:
    """How light is traced."""

    model: str = choice(
        "auto", "ray_model",
        "The space-time and the form of its light rays; auto: the cheapest that the tolerance allows, by the chart's measurements.",
    )
    integrator: str = choice("auto", "integrator", "One step of a marched model; auto as above.")
    step_control: str = choice("auto", "step_control", "How long the next step is; auto: what suits the model.")
    tolerance: float = number(0.5, 0.001, 100.0, "px", "Error allowed at 99 % of the pixels of a picture 1080 high, for what is chosen automatically.")
    step_length: float = number(0.0, 0.0, 2.0, "r_s", "Length Δt₀ of a Cartesian step (at r = 3 r_s where the step follows the radius); 0: from the tolerance.")
    step_angle: float = number(
        0.0, 0.0, 0.8, "rad",
        "Step κ, an angle, of models that march in angles: the smaller, the more exact, and the dearer; halving it divides the error by about 16. "
        "0: from the tolerance.",
    )
    max_steps: int = number(8192, 8, 30000, "", "No ray takes more steps. Steps are lengthened where fewer could not cross the scene.")
    field_radius: float = number(
        10.0, 0.5, 1000.0, "r_s", "Radius of the sphere about the origin within which a field bends rays; beyond it they run straight.",
    )
    field_way: float = number(
        400.0, 1.0, 1e5, "r_s", "Way within a field after which a ray is held there for good: it is black. Rays that a field lets out end in the sky.",
    )
    light_tolerance: float = number(
        0.001, 1e-5, 0.1, "×", "Error allowed for the light of media at 99 % of the pixels that show any, of the brightest, for steps chosen automatically.",
    )
    medium_step: float = number(
        0.0, 0.0, 1.0, "×",
        "Longest step in a medium, of the length on which the medium changes: halving it divides the error by up to sixteen. 0: from the light's tolerance.",
    )
    early_end: bool = switch(
        True, "End a ray's march where it has met something opaque, escapes or is captured. Off, for measurements: it is marched on as far as all steps lead.",
    )
    bounds: bool = switch(
        True,
        "Look for things and media only on steps that come near any, and there at none but those whose boxes are met. Off, for measurements: on every "
        "step, at all of them.",
    )
    orders: int = number(3, 1, 3, "", "How many crossings of the disk's plane are kept: 1 direct picture, 2 with the first ring, 3 with the second.")
    at_rest: int = number(
        17, 1, 17, "", "Rays a pixel that a picture takes where nothing moves, one more a frame; an even number shows as the odd one below it.",
    )
    in_stills: int = number(1, 1, 16, "", "Rays a pixel along each axis in pictures written by the command line.")
    refine: bool = switch(
        True,
        "While the camera moves, trace a coarse grid of exact rays and interpolate between them where the tolerance allows; at rest every "
        "pixel gets its own.",
    )
    edges: int = number(
        4, 1, 8, "",
        "Rays along each axis of a pixel within which what is seen changes: at the shadow's edge and on the rings, where one would leave a row of dots; odd "
        "numbers count as the next even one. 1: its own ray alone.",
    )
    light_travel: bool = switch(
        False,
        "Light takes its time: the disk's patterns, its hot spot, media and what moves are seen where they were when the light left them. A camera at infinity "
        "tells time by light that would have passed the hole undelayed. Off: all is seen as it is at scene time.",
    )
    lensing: bool = switch(True, "Off: light runs straight, with the hole a black ball.", physical=True)


@dataclass(frozen=True)
class Disk:
    """The thin accretion disk, in the plane z = 0 or tilted out of it."""

    enabled: bool = switch(True, "Show the disk.")
    inner_radius: float = number(0.0, 0.0, 20.0, "r_s", "Inner edge; never inside the innermost stable circular orbit (ISCO), which 0 chooses.")
    outer_radius: float = number(10.0, 1.0, 100.0, "r_s", "Outer edge; not inside the inner one.")
    thickness: float = number(
        0.5, 0.01, 2.0, "r_s",
        "Half the thickness of disks with depth, media of the kind slab, where they state none of their own; the disk itself is thin.",
    )
    tilt_deg: float = number(
        0.0, 0.0, 90.0, "°",
        "Tilt of the disk's rigid plane out of the equator. Kinematic: its matter goes round in that plane at the rate of a circular orbit; round a spinning "
        "hole a real one would precess and warp.",
    )
    tilt_azimuth_deg: float = number(0.0, -180.0, 180.0, "°", "Azimuth that the tilted disk's axis leans towards: there its plane lies lowest.")
    orbit: str = choice("prograde", ("prograde", "retrograde"), "Whether the matter turns with the hole's spin or against it.")
    plunging: bool = switch(
        False,
        "Matter inside the innermost stable orbit, too: it falls in with that orbit's energy and angular momentum, and goes on to shine from the temperature "
        "that it has there, which page_thorne makes 0 without a torque. Off: there is none.",
    )
    inner_torque: float = number(
        0.0, 0.0, 1.0, "", "Torque at the innermost stable orbit, as what it adds to the share of infalling mass that is turned into light. For page_thorne.",
    )
    temperature_law: str = choice("page_thorne", ("page_thorne", "shakura_sunyaev", "tapered"), "Temperature against radius.", physical="page_thorne")
    temperature_of: str = choice(
        "chosen", ("chosen", "accretion"),
        "The disk's highest temperature: chosen, or that of Page and Thorne's disk round a hole of the source's mass, by its accretion rate.",
    )
    temperature_k: float = number(4500.0, 1000.0, 40000.0, "K", "Highest temperature in the disk, seen by an observer moving with the matter, where chosen.")
    accretion_rate: float = number(0.1, 1e-6, 10.0, "L_Edd", "Mass that falls in per time, as the light that it makes over Eddington's luminosity.")
    colour_hardening: float = number(1.7, 1.0, 3.0, "×", "Temperature of the light's colour over that of its flux, where it follows from accretion.")
    limb_darkening: str = choice(
        "none", ("none", "grey", "scattering"),
        "Brightness by the angle at which light leaves the matter: the same, that of a grey atmosphere (2 + 3 cos), or of one that scatters (1 + 2.06 cos).",
    )
    frequency_shift: str = choice(
        "exact", ("exact", "s0", "s1"),
        "The g-factor, energy received over energy sent out: exact, or by an older viewer's formula, that of the orbital-plane renderer (s0) or of "
        "BlackHoleGPU (s1).",
        physical="exact",
    )
    beaming_exponent: float = number(4.0, 0.0, 6.0, "", "p in I_obs = g^p I: 4 for bolometric radiance, 3 for one frequency.")
    orders_shown: str = choice(
        "all", ("all", "direct", "first_ring", "second_ring", "tinted"),
        "All images of the disk, one alone, or each in a colour of its own: direct orange, first ring green, second ring blue.",
        physical="all",
    )
    colour: str = choice(
        "blackbody", ("blackbody", "white"),
        "The colours that the temperatures have, or white light of the same luminance: the brightness alone, as on a black-and-white plate.",
    )
    doppler_colour: bool = switch(True, "Shift the colour by the motion of the matter.", physical=True)
    beaming: bool = switch(True, "Brighten what approaches, dim what recedes.", physical=True)
    redshift: bool = switch(True, "Redden and dim what climbs out of the well.", physical=True)
    compositing: str = choice("opacity", ("additive", "opacity"), "Whether crossings add up or nearer ones hide farther ones.", art=True)
    opacity: float = number(0.85, 0.0, 1.0, "", "How much of what lies behind a crossing is hidden, where the disk is dense.", art=True)
    emission_strength: float = number(0.18, 0.0, 2.0, "", "Brightness of the disk.", art=True)
    density_gain: float = number(9200.0, 0.0, 40000.0, "", "Contrast of the look layers.", art=True)
    noise_scale: float = number(0.68, 0.01, 5.0, "1/r_s", "Frequency of the coarsest pattern of the look layers.", art=True)
    noise_speed: float = number(0.7, 0.0, 5.0, "×", "How fast the look layers' pattern orbits; 1 is the Keplerian rate.", art=True)


@dataclass(frozen=True)
class Polarization:
    """How the light of the smooth disk is polarized, and whether that is shown. It changes nothing of the picture beneath."""

    ticks: bool = switch(False, "Ticks along the polarization over the picture, saved ones too; as long as the fourth root of the polarized light.")
    tick_rows: int = number(24, 4, 120, "", "Rows of ticks in a picture's height.")
    emission: str = choice(
        "synchrotron", ("synchrotron", "atmosphere"),
        "Synchrotron light of electrons in a magnetic field, or light that a thick atmosphere of electrons has scattered (Chandrasekhar).",
    )
    field_vertical: float = number(1.0, -1.0, 1.0, "", "Part of the magnetic field along the axis, in the frame of the matter. Ratios alone matter.")
    field_radial: float = number(0.0, -1.0, 1.0, "", "Part of the magnetic field outwards.")
    field_toroidal: float = number(0.0, -1.0, 1.0, "", "Part of the magnetic field round the axis, counter-clockwise seen from +z.")


@dataclass(frozen=True)
class Sky:
    """What lies behind everything."""

    enabled: bool = switch(True, "Show stars and galaxy.")
    model: str = choice("procedural", "sky", "Where the sky's radiance comes from.")
    brightness: float = number(1.0, 0.0, 10.0, "×", "Brightness of the whole sky.", art=True)


@dataclass(frozen=True)
class Post:
    """From scene radiance to the picture on the screen."""

    view: str = choice(
        "picture", ("picture", "steps", "order", "g_factor", "temperature", "difference", "conservation", "unresolved"),
        "The picture, or in false colours: steps of a ray, crossings of the disk, g-factor, temperature of the disk's light, displacement from the "
        "most accurate method, drift of conserved quantities, unresolved rays.",
    )
    labels: bool = switch(
        False,
        "Names and outlines, where closed forms put them: shadow, innermost stable orbit, rings by order, approaching and receding side. Saved pictures have "
        "them too; in the window they wait while the camera moves, but where it turns about the spin axis.",
    )
    show_horizon: bool = switch(False, "Tint where light paths end on the horizon, as one sees it: the shadow.")
    show_ergosphere: bool = switch(False, "Draw where the disk's plane enters the ergosphere, in which nothing stands still, by every image of it.")
    show_photon_shell: bool = switch(False, "Draw where light can circle in the disk's plane: from the orbit of light that goes with the spin to the other.")
    show_isco: bool = switch(False, "Draw the innermost stable circular orbit in the disk's plane, by every image of it.")
    show_plane_grid: bool = switch(False, "Draw circles of whole r_s and rays every 30° in the disk's plane, as far as the disk reaches, by every image.")
    show_sky_grid: bool = switch(False, "Draw latitude and longitude every 15° on the sky, about the hole's axis, where its light paths put them.")
    legend: bool = switch(True, "Draw a view's colours and scale into saved pictures of it; the window always shows them.")
    exposure: float = number(0.0, -8.0, 8.0, "stops", "Each stop doubles the light; on top of what automatic exposure finds.")
    exposure_mode: str = choice(
        "fixed", ("fixed", "automatic"),
        "Automatic: a light meter at the camera looks at all that shines round the hole, and three fifths of the stops between its bright parts "
        "and the key light are made up for. Neither time nor the way the camera looks changes it.",
    )
    key_light: float = number(0.255, 0.01, 10.0, "", "Radiance of the bright parts that automatic exposure leaves as they are.")
    bloom: bool = switch(True, "Glow around bright places, as in a lens.")
    bloom_threshold: float = number(0.68, 0.0, 5.0, "", "Radiance above which light glows.")
    bloom_intensity: float = number(0.45, 0.0, 2.0, "", "Strength of the glow.")
    bloom_spread: float = number(1.0, 0.1, 3.0, "×", "Width of the glow.")
    beam: bool = switch(
        False,
        "Blur the picture as an array of telescopes does: by a round Gaussian beam, before all else that makes light a picture. Its size on the sky goes by "
        "the real object's mass and distance; beyond the picture's edge its outermost light is taken to go on.",
    )
    beam_uas: float = number(20.0, 0.1, 1000.0, "µas", "Full width of the beam at half of its maximum.")
    colours: str = choice(
        "light", ("light", "afmhot"),
        "The light's own colours, or its luminance over that of the brightest pixel, in equal steps from black over red, orange and yellow to white: exposure, "
        "glow, tone curve and gamma have no bearing then.",
    )
    lens: bool = switch(
        False,
        "Displace the finished picture about the hole's place on it, as a thin lens does with what lies far behind: offset ×= 1 − 2 Rad/(ρ √D)², with ρ on a "
        "screen at distance 1 and the camera's distance D, whatever the rays did before. From infinity nothing is displaced.",
        physical=False,
    )
    lens_radius: float = number(1.0, 0.0, 100.0, "r_s", "Rad there, 1 for the hole itself. Its Einstein ring is √(2 Rad/D) from the hole on that screen.")
    lens_shadow: float = number(1.0, 0.0, 100.0, "r_s", "Radius of the black disc over the displaced picture, seen at the hole's distance.")
    lens_ring: bool = switch(False, "Draw a line where the Einstein ring is.")
    tone_map: str = choice("aces", ("linear", "reinhard", "aces", "agx"), "How scene radiance becomes screen brightness.")
    gamma: float = number(1.0, 0.2, 3.0, "", "Creative gamma on top of the screen's own.")
    dither: bool = switch(True, "Noise of less than one grey level against banding in the dark sky.")

    @property
    def lines_in_plane(self) -> bool:
        """Whether anything is to be drawn in the disk's plane that is no matter."""
        return self.show_ergosphere or self.show_photon_shell or self.show_isco or self.show_plane_grid


@dataclass(frozen=True)
class Playback:
    """How scene time runs in the window."""

    rate: float = number(4.0, 0.0, 100.0, "(r_s/c)/s", "Scene time that passes in one second.")
    target_fps: float = number(
        30.0, 0.0, 120.0, "fps",
        "Frame rate that a moving camera holds by drawing fewer pixels; a resting one before a turning disk keeps about half of it. At rest "
        "every pixel is drawn. 0: off, always full resolution.",
    )
    coarsest: float = number(
        0.25, 0.1, 1.0, "×",
        "Least width and height of a picture under a moving camera, over those of its area; before a disk that turns it is at least twice that.",
    )


SECTIONS: Mapping[str, type] = MappingProxyType(
    {"hole": Hole, "source": Source, "camera": Camera, "rays": Rays, "disk": Disk, "polarization": Polarization, "sky": Sky, "post": Post, "playback": Playback}
)
"""The sections by name, in the order of panels and files."""

INCREASING: Mapping[str, tuple[str, ...]] = MappingProxyType({"disk": ("inner_radius", "outer_radius")})
"""Section → those of its numbers none of which may be larger than the one after it."""


def declared() -> dict[str, Mapping[str, Any]]:
    """What each field says of itself, by dotted key: the arguments of `schema.Field`, but that a choice's ``options`` may name a catalogue slot."""
    return {
        f"{section}.{item.name}": {**item.metadata, "default": item.default} for section, kind in SECTIONS.items() for item in record_fields(kind)
    }

"""MuJoCo through its own interface: a model in its own language, then ``mj_step``.

It has no coefficient of restitution. Well set, a contact is a spring and a damper (``solref``), whose damping
ratio 0.2553 gives half of the speed back when the force cannot pull; 0 gives all of it.
"""

import measures
import mujoco

#: e = exp(-(z / w) (pi - atan2(2 z w, w² - z²))), w² = 1 - z²: solved for e = 0.5.
HALF_BACK = 0.2552756376486518


def _spring(radians_a_step, damping_ratio):
    frequency = radians_a_step / measures.STEP
    return {"solref": f"{-(frequency**2)!r} {-2 * damping_ratio * frequency!r}", "solimp": "0.99 0.99 0.001"}


STIFF = {"solref": f"{2 * measures.STEP!r} 1", "solimp": "0.99 0.99 0.001"}
WELL_SET = {
    "bounce": {"integrator": "RK4", **_spring(0.7, HALF_BACK)},
    "small-drop": {"integrator": "RK4", **_spring(0.7, HALF_BACK)},
    "clash": _spring(0.1, 0.0),
    "slide": {"cone": "elliptic", "impratio": 100},
    "mass-ratio": STIFF,
}
EXTRA = {
    "damping ratio of a spring that may pull": ("bounce", {"integrator": "RK4", **_spring(0.7, 0.2155)}),
    "elliptic cone alone": ("slide", {"cone": "elliptic"}),
}


def make(bodies, settings, gravity, friction, restitution, floor):
    """See ``measures``; ``settings`` are attributes of ``option`` and of every ``geom``."""
    geom = {"friction": repr(friction)}
    option = {"timestep": repr(measures.STEP), "gravity": " ".join(repr(float(g)) for g in gravity)}
    for name, value in settings.items():
        (geom if name in ("solref", "solimp") else option)[name] = value
    surface = _attributes(geom)
    parts = []
    for kind, size, mass, place, _velocity in bodies:
        shape = (
            f'type="sphere" size="{size}"' if kind == "ball" else f'type="box" size="{size} {size} {size}"'
        )
        where = " ".join(repr(float(x)) for x in place)
        parts.append(f'<body pos="{where}"><freejoint/><geom {shape} mass="{mass}" {surface}/></body>')
    if floor:
        parts.append(f'<geom type="plane" size="0 0 1" {surface}/>')
    text = f"<mujoco><option {_attributes(option)}/><worldbody>{''.join(parts)}</worldbody></mujoco>"
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    for i, body in enumerate(bodies):
        data.qvel[6 * i : 6 * i + 3] = body[4]

    def read(i):
        return tuple(map(float, data.qpos[7 * i : 7 * i + 3])), tuple(
            map(float, data.qvel[6 * i : 6 * i + 3])
        )

    return lambda: mujoco.mj_step(model, data), read


def _attributes(values):
    return " ".join(f'{name}="{value}"' for name, value in values.items())


if __name__ == "__main__":
    measures.main(make, WELL_SET, EXTRA)

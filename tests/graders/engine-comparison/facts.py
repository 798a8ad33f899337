"""What is right to say of ODE, Bullet, PhysX and MuJoCo, with what is often said and no longer true.

They are what the engines' own licence files, manuals and headers say: ODE's manual, Bullet's
``btDynamicsWorld.h`` and PyBullet's ``setTimeStep``, PhysX's ``PxScene::simulate``, MuJoCo's XML reference.
"""

from __future__ import annotations

import datetime
import re

#: Identifiers that are right, in lower case: SPDX identifiers do not depend on case.
LICENCES = {
    "ode": {"bsd-3-clause", "lgpl-2.1-or-later", "lgpl-2.1-only", "lgpl-2.1", "lgpl-2.1+"},
    "bullet": {"zlib"},
    "physx": {"bsd-3-clause"},
    "mujoco": {"apache-2.0"},
}

#: Words of licences that these engines once had.
STALE = ("proprietary", "commercial", "nvidia", "eula", "closed", "roboti", "licenseref", "paid", "trial")

#: Identifiers of licences that these engines do not have, in lower case: well-formed, and wrong here.
IDENTIFIERS = {
    "mit", "mit-0", "apache-1.1", "apache-2.0", "bsd-2-clause", "bsd-3-clause", "bsd-4-clause", "zlib", "isc",
    "bsl-1.0", "mpl-1.1", "mpl-2.0", "epl-1.0", "epl-2.0", "cc0-1.0", "unlicense", "wtfpl", "0bsd",
    *(f"{name}{ending}"
      for name in ("gpl-1.0", "gpl-2.0", "gpl-3.0", "lgpl-2.0", "lgpl-2.1", "lgpl-3.0", "agpl-3.0")
      for ending in ("", "+", "-only", "-or-later")),
}  # fmt: skip

#: Words of a licence's everyday name: the right licence, not its identifier.
EVERYDAY = {
    "ode": ("lgpl", "gpl", "bsd"),
    "bullet": ("zlib",),
    "physx": ("bsd",),
    "mujoco": ("apache",),
}

#: Since when the licence has been this one, where it was another before.
SINCE = {
    "physx": datetime.date(2018, 12, 1),
    "mujoco": datetime.date(2022, 5, 23),
}

#: The language the engine is written in. A little C beside it, as in C/C++, spoils none; C alone, that of
#: ODE's interface, is the language of MuJoCo only.
LANGUAGES = {
    "ode": {"c++"},
    "bullet": {"c++"},
    "physx": {"c++"},
    "mujoco": {"c", "c++"},
}

#: Languages from which the engine can be called, and in which it is not written.
INTERFACES = {
    "ode": {"c", "python"},
    "bullet": {"c", "python"},
    "physx": {"python"},
    "mujoco": {"python"},
}

#: All four update the velocity first and move the position with the new one, unless told otherwise.
INTEGRATOR = "semi_implicit_euler"

#: Seconds; None where the caller has to pass the step.
STEPS = {
    "ode": (None,),
    "bullet": (1 / 60, 1 / 240),  # the library's own, and that of its Python module
    "physx": (None,),
    "mujoco": (0.002,),
}

#: Part of a name, in lower case, that marks a project running on the engine.
USERS = {
    "ode": ("gazebo classic", "gazebo-classic", "gazebo 9", "gazebo 11", "gazebo9", "gazebo11", "webots",
            "coppelia", "v-rep", "opensimulator", "panda3d", "openrave", "pyode"),
    "bullet": ("pybullet", "blender", "coppelia", "v-rep", "gazebo", "panda3d", "godot", "maya", "houdini",
               "cinema 4d", "drake", "openrave", "gibson", "habitat", "tesseract", "dart", "moveit"),
    "physx": ("isaac", "omniverse", "unity", "unreal", "sapien", "maniskill", "o3de", "lumberyard", "carla",
              "airsim", "orbit", "omnigibson"),
    "mujoco": ("gymnasium", "gym", "dm_control", "dm control", "dm-control", "robosuite", "playground", "mjx",
               "metaworld", "meta-world", "robohive", "myosuite", "deepmind", "newton", "openai", "libero",
               "robocasa", "aloha"),
}  # fmt: skip

#: Parts of names that hold one of the above by chance, and run on another engine.
NOT_USERS = {
    "bullet": ("omnigibson",),
    "mujoco": ("isaac",),
}

#: Names of the Gazebo that does not run on ODE.
NEW_GAZEBO = ("gazebo sim", "gz sim", "gz-sim", "ignition", "gazebo harmonic", "gazebo fortress",
              "gazebo garden", "gazebo ionic", "gazebo jetty")  # fmt: skip


def languages(text: str) -> set[str]:
    """The languages of an answer, such as "C++17" or "C and C++"."""
    parts = re.split(r"[/,&]|\band\b|\bor\b", plain(text))
    return {re.sub(r"^c\+\+ ?\d\d$", "c++", part.strip()) for part in parts}


def right_language(engine: str, text: str) -> bool:
    """Whether one of the engine's languages is named, and none but C and C++."""
    named = languages(text)
    return bool(named & LANGUAGES[engine]) and named <= {"c", "c++"}


def spdx(text: str) -> list[str]:
    """The identifiers of an SPDX expression that joins them with OR, in lower case."""
    parts = text.strip().strip("()").lower().split(" or ")
    return [part.strip().strip("()") for part in parts]


def right_licence(engine: str, text: str) -> bool:
    """Whether every identifier of the expression is one the engine may be used under."""
    return all(part in LICENCES[engine] for part in spdx(text))


def licence_mistake(engine: str, text: str) -> str | None:
    """The code of a wrong licence: outdated, another engine's, or the right one by its everyday name."""
    words = plain(text)
    right = any(word in words for word in EVERYDAY[engine])
    if engine in SINCE and not right and any(word in words for word in STALE):
        return "STALE_LICENCE"
    if all(part in IDENTIFIERS for part in spdx(text)):
        return "OTHER_LICENCE"
    return "NOT_SPDX" if right else None


def plain(text: str) -> str:
    """A name without case and odd spaces."""
    return " ".join(text.lower().split())


def right_user(engine: str, name: str) -> bool:
    """Whether a project is known to run on the engine."""
    if engine == "ode" and plain(name) == "gazebo":
        return False
    if any(part in plain(name) for part in NOT_USERS.get(engine, ())):
        return False
    return any(part in plain(name) for part in USERS[engine])


def is_new_gazebo(name: str) -> bool:
    """Whether it is the Gazebo that runs on DART; the bare name has meant that one since 2025."""
    return plain(name) == "gazebo" or any(part in plain(name) for part in NEW_GAZEBO)

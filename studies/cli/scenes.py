"""The shipped scenes, for people: their names, what each is, their text."""

from __future__ import annotations

from importlib.resources import files

from rigid import SceneError, load_scene, scene_names


def text(name: str) -> str:
    """The TOML of a shipped scene.

    Raises
    ------
    SceneError
        There is no scene of that name.
    """
    if name not in scene_names():
        load_scene(name)  # says which names are near
        raise SceneError(f"{name} is a file, not a shipped scene: it can be read as it is.")
    return (files("rigid.scenes") / f"{name}.toml").read_text(encoding="utf-8")


def listing() -> str:
    """One line for each shipped scene: its name and the comment it starts with."""
    lines = []
    for name in scene_names():
        first = text(name).splitlines()[0]
        lines.append(f"{name:24} {first.lstrip('# ') if first.startswith('#') else ''}".rstrip() + "\n")
    return "".join(lines)

"""Is there anything to draw with? VTK crashes the process where it finds no screen, no EGL, no OSMesa."""

from __future__ import annotations

import os
import subprocess
import sys
from functools import cache

_WINDOW = "VTK_DEFAULT_OPENGL_WINDOW"
_PROBE = """
import vtkmodules.vtkRenderingOpenGL2
from vtkmodules.vtkRenderingCore import vtkRenderer, vtkRenderWindow
window = vtkRenderWindow()
window.SetOffScreenRendering(1)
window.SetSize(8, 8)
window.AddRenderer(vtkRenderer())
window.Render()
print("drawn by", window.GetClassName())
"""


class ViewError(ValueError):
    """A picture that cannot be made: one sentence that says why and what would help."""


@cache
def probe() -> tuple[str, str | None]:
    """The kind of VTK's off-screen window, and why there is none in a sentence, or None.

    Found out once, in a process of its own that may crash.
    """
    command = [sys.executable, "-c", _PROBE]
    try:
        tried = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    except (OSError, subprocess.TimeoutExpired) as error:
        return "", f"VTK could not be tried out for rendering: {error}."
    _, found, window = tried.stdout.strip().rpartition("drawn by ")
    if tried.returncode == 0 and found:
        return window, None
    if "ModuleNotFoundError" in tried.stderr:
        return "", "pictures need pyvista, which is not installed: pip install pyvista."
    return "", (
        "VTK finds nothing to draw with: without a screen it needs EGL or OSMesa; on Debian or Ubuntu, "
        "apt-get install libegl1 libegl-mesa0 libgl1-mesa-dri."
    )


def renderer_problem() -> str | None:
    """Why nothing can be drawn, in a sentence, or None."""
    return probe()[1]


def choose_window(off_screen: bool) -> None:
    """Have VTK take at once the kind of window that the probe found, without complaints about others."""
    if off_screen and sys.platform.startswith("linux"):
        os.environ.setdefault(_WINDOW, probe()[0])
    elif os.environ.get(_WINDOW) == probe()[0]:
        del os.environ[_WINDOW]


def require_renderer() -> None:
    """Raise :class:`ViewError` where nothing can be drawn."""
    problem = renderer_problem()
    if problem is not None:
        raise ViewError(problem)


def require_screen() -> None:
    """Raise :class:`ViewError` where no window can be opened."""
    require_renderer()
    screen = os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")
    if sys.platform.startswith("linux") and not screen:
        raise ViewError("there is no screen for a window: ask for --png, --gif, --mp4 or --html.")

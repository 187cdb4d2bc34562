"""How thin a wall the mesh knows, quads stretch h^-2 times as hard as they bend; and how light a hoop may be."""

from math import radians

import numpy as np
import pytest

import flexible
import rigid
from flexible.ring.choice import ring_of
from flexible.ring.fem import Ring
from flexible.ring.possible import LEAST_MASS, THINNEST
from meshes import ring_mesh
from rigid import Friction, Hoop, Release, Scene, SceneError
from rigid import Ring as Elastic


def frequencies(wall, around):
    """Three lowest, of an inextensible line in sqrt(E I/(m_h rho^3)) as h goes to 0: E I = E b h^3/12."""
    ring = Ring(ring_mesh(1 - wall, 1.0, around, 1, radians(3)), 0.3)
    squared = 12 * ring.modes(3)[0] / wall**3 * (1 - wall / 2) ** 3
    return np.sqrt(np.maximum(squared, 0.0))


def test_the_thinnest_wall_vibrates_as_a_line():
    """Quads 29 walls long are stiffer than the line, by 2 % (3e-4 of a pulse's J_N), and by the fourth power of that.

    A tenth of it is known by no number of quads: of the first frequencies rounding leaves no digit.
    """
    line = 2 * frequencies(0.005, 960) - frequencies(0.01, 480)  # the wall's own share is linear in it
    off = np.array([frequencies(THINNEST, around) / line - 1 for around in (240, 480)])
    assert off[0] == pytest.approx(0, abs=0.025)
    assert off[1] == pytest.approx(0, abs=0.002)
    for around in (240, 480):
        assert not np.abs(frequencies(THINNEST / 10, around) / line - 1).max() < 0.1


@pytest.mark.parametrize("level", ["auto", "reduced", "chain", "exact", "full"])
def test_a_thinner_one_is_refused(level):
    scene = Scene(Hoop(k=0.1, r=1.0008), Friction(0.35, 0.3), Release(1.0), ring=Elastic(bending_stiffness=100.0))
    scene = scene.replace(solve={"level": level})
    with pytest.raises(SceneError, match="too thin for the quads"):
        flexible.simulate(scene)
    assert ring_of(scene.replace(hoop={"r": 1.0}, ring={"thickness": 0.001})).mesh.grid.shape[1] > 0, "as it says"


@pytest.mark.parametrize("law", ["patch", "brush"])
def test_a_hoop_with_next_to_no_mass_is_refused(law):
    """The rigid one may have it; one at the bound moves like that without."""
    scene = rigid.load_scene("paper-3.3-massless").replace(run={"until": "pulse"}, solve={"rtol": 1e-3})
    without = scene.replace(contact={"law": law, "stiffness": 1e8})
    light = without.replace(hoop={"mass_ratio": 0.99 * LEAST_MASS})
    with pytest.raises(SceneError, match=r"^hoop\.mass_ratio = 9\.9e-09 is not possible here.*; take 0"):
        flexible.simulate(light)
    assert rigid.simulate(light).completed
    both = without, without.replace(hoop={"mass_ratio": LEAST_MASS})
    none, least = (flexible.simulate(one).pulses[0].impulse_ratio for one in both)
    assert least == pytest.approx(none, rel=1e-3)


def test_a_point_mass_needs_a_hoop_with_a_mass():
    """Without either nothing resists a turn about it."""
    heavy = Scene(Hoop(k=0.0, r=1.02, mass_ratio=0.1), Friction(0.35, 0.3), Release(1.0))
    flexible.ensure_possible(heavy)
    flexible.ensure_possible(heavy.replace(hoop={"k": 0.1, "mass_ratio": 0.0}))
    with pytest.raises(SceneError, match=r"hoop\.k = 0"):
        flexible.ensure_possible(heavy.replace(hoop={"r": 1.0, "mass_ratio": 0.0}))

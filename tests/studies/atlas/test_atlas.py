"""The atlas: what is filled is what would have been run, boundaries lie where closed forms put them."""

from __future__ import annotations

import json
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from command_line import is_one_sentence

from rigid import Friction, Hoop, Release, Scene, SceneError, load_scene, rolling_k, simulate
from rigid.lists import phases_of
from studies import Atlas, atlas_of
from studies.atlas.figures import Drawn, fixed
from studies.atlas.plane import NO_HOOP, SYMBOLS, Region, plane
from studies.atlas.refine import WITHIN, Seen, refined
from studies.atlas.study import SHADE
from studies.atlas.summary import atlas_sheets

SIDE = 64


@pytest.fixture(scope="module")
def drawn() -> Atlas:
    """k = 0.02 to 0.9, mu = 0.02 to 1."""
    return atlas_of(side=SIDE)


def test_what_is_filled_is_what_runs_give(drawn: Atlas):
    """Every hoop of the grid run: no other sequence, and no value off by more than two shades.

    A cell is filled when its centre is within one shade of the mean of its corners; a smooth function is then within
    about that everywhere in it, and twice that is allowed.
    """
    share = np.linspace(0, 1, SIDE + 1)
    across, up = (axis.ravel() for axis in np.meshgrid(share, share))
    chosen = drawn.plane
    seen = chosen.run(chosen.across.at(across), chosen.up.at(up))
    assert np.array_equal(seen.sequence.reshape(drawn.sequence.shape), drawn.sequence)
    assert 0 < drawn.found.computed.mean() < 0.6  # it did fill
    for run, filled in zip((seen.share, seen.loss, seen.peak), drawn.found.values, strict=True):
        assert np.nanmax(np.abs(run.reshape(filled.shape) - filled)) <= 2 * SHADE * np.ptp(run)
    computed = drawn.found.computed
    assert np.array_equal(drawn.found.values[0][computed], seen.share.reshape(computed.shape)[computed])


def test_the_arrays_of_a_map_are_in_the_units_that_they_say(drawn: Atlas):
    """Where hoops were run: J_F/(mu J_N), loss over M g R and peak over M g of the motion of that row and column."""
    for row, column in ((16, 16), (48, 0), (0, 64)):
        assert drawn.found.computed[row, column]
        k, mu = float(drawn.x[column]), float(drawn.y[row])
        friction = {"mu": mu, "mu_s": mu * 0.35 / 0.3}
        pulse = simulate(load_scene("paper-3.1").replace(hoop={"k": k}, friction=friction)).pulses[0]
        told = [a[row, column] for a in (drawn.impulse_share, drawn.friction_loss, drawn.peak_normal_force)]
        wanted = [pulse.impulse_ratio / mu, pulse.friction_loss, pulse.peak_normal_force]
        assert told == pytest.approx(wanted, rel=1e-9, abs=1e-12)


def test_rolling_throughout_begins_where_the_closed_form_has_it(drawn: Atlas):
    """The last slip of the pulse ends at the k of section 3.2, to a part of a square."""
    rows = WITHIN * SIDE
    row = int((0.3 - 0.02) / 0.98 * rows)
    mu = 0.02 + 0.98 * (row + 0.5) / rows
    rolls = drawn.found.squares[row] == 1  # a single phase, rolling
    assert phases_of(1.0) == ("roll",)
    edge = 0.02 + 0.88 * (int(np.flatnonzero(~rolls).max()) + 1) / rows
    exact = rolling_k(mu * 0.35 / 0.3, Release(phi0_deg=10))
    # the part on one side of the edge is judged by its centre
    assert abs(edge - exact) <= 0.88 / rows


@pytest.mark.parametrize("name", ["paper-3.1", "paper-3.2-k0.25", "paper-3.2-k0.5", "paper-3.2-k0.75"])
def test_the_papers_scenes_are_where_their_sequence_is(drawn: Atlas, name: str):
    places = {f"paper-{place[0]}": place[1:] for place in drawn.plane.scenes_of_the_paper()}
    x, y = places[name]
    scene = load_scene(name)
    assert (x, y) == (scene.hoop.k, scene.friction.mu)
    motion = simulate(scene)
    pulse = motion.pulses[0]
    inside = [str(p.kind) for p in motion.phases if p.t_end > pulse.t_start and p.t_start < pulse.t_end]
    rows = WITHIN * SIDE
    part = drawn.found.squares[int((y - 0.02) / 0.98 * rows), int((x - 0.02) / 0.88 * rows)]
    assert [region.phases for region in drawn.regions if region.sequence == part] == [", ".join(inside)]


def test_scenes_of_another_hoop_are_not_marked(drawn: Atlas):
    """3.3-massless has r = 1.02, 3.4 a hoop with mass; in their own plane the latter are there."""
    marked = {name for name, _, _ in drawn.plane.scenes_of_the_paper()}
    assert marked == {"3.1", "3.2-k0.25", "3.2-k0.5", "3.2-k0.5385", "3.2-k0.75"}
    other = plane(load_scene("paper-3.3-heavier"), {"hoop.mass_ratio": (0.01, 5.0), "friction.mu": (0.02, 1.1)})
    assert {name for name, _, _ in other.scenes_of_the_paper()} == {
        "3.3-heavier", "3.3-light", "3.3-same-density", "3.4-rough", "3.4-slippery",
    }  # fmt: skip


def test_regions_are_all_of_the_map(drawn: Atlas):
    assert sum(region.share for region in drawn.regions) == pytest.approx(1.0)
    assert [r.share for r in drawn.regions] == sorted((r.share for r in drawn.regions), reverse=True)
    for region in drawn.regions:
        assert np.mean(drawn.found.squares == region.sequence) == pytest.approx(region.share)


def test_the_ratio_of_the_coefficients_is_the_scenes():
    scene = load_scene("paper-3.1")
    for key in ("friction.mu", "friction.mu_s"):
        hoops = plane(scene, {"hoop.k": (0.1, 0.5), key: (0.1, 0.5)}).hoops(np.array([0.2, 0.3]), np.array([0.2, 0.4]))
        assert hoops["mu_s"] / hoops["mu"] == pytest.approx(0.35 / 0.3)
        assert hoops["phi0"] == pytest.approx(np.deg2rad(10))


def test_a_scene_that_slips_without_friction_keeps_to_that():
    """mu_s is the bound of what sticks, of which mu = 0 says nothing; where both are 0 they are equal."""
    scene = load_scene("paper-3.1")
    for mu_s, mu in ((0.35, [0.0, 0.0]), (0.0, [0.2, 0.4])):
        over = plane(
            scene.replace(friction={"mu_s": mu_s, "mu": 0.0}), {"hoop.k": (0.1, 0.5), "friction.mu_s": (0.1, 0.5)}
        )
        hoops = over.hoops(np.array([0.2, 0.3]), np.array([0.2, 0.4]))
        assert hoops["mu_s"].tolist() == [0.2, 0.4]
        assert hoops["mu"].tolist() == mu


def test_a_hoop_with_mass_is_measured_by_its_whole_weight():
    """Of a map over its mass: loss over M g R and peak over M g, as one motion has them over m g."""
    scene = load_scene("paper-3.3-heavier")
    ratios = np.array([0.1, 0.5])
    seen = plane(scene, {"hoop.mass_ratio": (0.05, 1.0), "friction.mu": (0.1, 0.5)}).run(ratios, np.array([0.3, 0.2]))
    for i, (ratio, mu) in enumerate(zip(ratios, (0.3, 0.2), strict=True)):
        friction = {"mu": mu, "mu_s": mu * scene.friction.mu_s / scene.friction.mu}
        hoop = scene.replace(hoop={"mass_ratio": float(ratio)}, friction=friction, run={"until": "pulse"})
        pulse = simulate(hoop).pulses[0]
        assert pulse.friction_loss > 0
        assert seen.loss[i] == pytest.approx(pulse.friction_loss / (1 + ratio), rel=1e-9)
        assert 10 ** seen.peak[i] == pytest.approx(pulse.peak_normal_force / (1 + ratio), rel=1e-9)
        assert seen.share[i] == pytest.approx(pulse.impulse_ratio / mu, rel=1e-9)


def test_no_hoop_has_less_static_than_kinetic_friction():
    found = atlas_of("paper-3.1", {"friction.mu_s": (0.0, 1.0), "friction.mu": (0.0, 1.0)}, side=16)
    mu_s, mu = np.meshgrid(found.x, found.y)
    assert np.array_equal(found.sequence == NO_HOOP, mu_s < mu)
    assert np.isnan(found.impulse_share[mu_s < mu]).all()


def test_hoops_that_hop_are_told():
    """From rest no hoop hops; with enough spin each does, before its disk is down."""
    found = atlas_of("paper-3.1", {"release.omega0": (0.0, 4.0), "friction.mu": (0.1, 0.5)}, side=16)
    assert not found.found.hops[:, 0].any()
    assert found.found.hops[:, -1].all()
    for column, expected in ((0, False), (-1, True)):
        scene = load_scene("paper-3.1").replace(
            release={"omega0": float(found.x[column])}, friction={"mu": 0.1, "mu_s": 0.35 / 3}, run={"until": "pulse"}
        )
        assert any(phase.kind == "flight" for phase in simulate(scene).phases) is expected


def test_what_is_filled_among_hoops_that_bounce_is_what_runs_give():
    """Every hoop of the grid run, at most two shades off as where none bounces: what is left of a throw jumps with the
    number of bounces before the pulse, by a tenth of the range of the loss and more, within one sequence of phases.
    """
    over = {"landing.restitution": (0.25, 0.75), "release.omega0": (3.5, 10.0)}
    found = atlas_of("paper-3.1", over, side=SIDE)
    x, y = (axis.ravel() for axis in np.meshgrid(found.x, found.y))
    seen = found.plane.run(x, y)
    assert len(np.unique(seen.hops)) > 5
    assert not found.found.computed.all(), "it did fill"
    assert np.array_equal(seen.hops.reshape(found.sequence.shape) > 0, found.found.hops)
    for run, filled in zip((seen.share, seen.loss, seen.peak), found.found.values, strict=True):
        assert np.nanmax(np.abs(run.reshape(filled.shape) - filled)) <= 2 * SHADE * np.ptp(run)


def test_what_is_left_of_a_pulse_at_release_is_not_measured():
    """Released around the bottom, before or behind it: mapped is the first whole pulse, as one hoop tells it."""
    scene = Scene(Hoop(0.3), Friction(0.35, 0.3), Release(phi0_deg=175, omega0=2.0))
    found = atlas_of(scene, {"release.phi0_deg": (170.0, 186.0), "release.omega0": (1.0, 3.0)}, side=16)
    for column, row in ((8, 8), (0, 0), (16, 4)):
        release = {"phi0_deg": float(found.x[column]), "omega0": float(found.y[row])}
        motion = simulate(scene.replace(release=release, run={"turns": 2}))
        assert motion.pulses[0].cut
        pulse = next(pulse for pulse in motion.pulses if not pulse.cut)
        told = found.found.values[:, row, column]
        wanted = [pulse.impulse_ratio / 0.3, pulse.friction_loss, np.log10(pulse.peak_normal_force)]
        assert told == pytest.approx(wanted, abs=2 * SHADE)  # of ranges of the order of one


def test_a_map_of_jams_alone_has_no_peaks_and_is_drawn():
    scene = Scene(Hoop(0.0432, 1.52), Friction(0.538, 0.481), Release(phi0_deg=102.6, omega0=3.85, slip0=-2.41))
    found = atlas_of(scene, {"release.phi0_deg": (102.5, 102.7), "release.omega0": (3.8, 3.9)}, side=16)
    assert all("impact" in region.phases for region in found.regions)
    assert np.isnan(found.found.values[2]).all()
    assert np.isfinite(found.found.values[:2]).all()
    assert found.plot().axes


def test_hoops_that_jam_are_told():
    """A skid released where D = K + e s (e s + mu (1 + e c)) < 0 jams at once (Painleve); below the least mu that has
    such a place, (K + e^2 s^2)/(e |s| (1 + e c)), no hoop ever does.
    """
    scene = load_scene("paper-3.1").replace(release={"slip0": 1.0})
    found = atlas_of(scene, {"release.phi0_deg": (181.0, 359.0), "friction.mu": (0.02, 1.5)}, side=32)
    e, gyr = scene.hoop.e, scene.hoop.K
    phi, mu = np.meshgrid(np.deg2rad(found.x), found.y)
    s, arm = np.sin(phi), 1 + e * np.cos(phi)
    jams = gyr + e * s * (e * s + mu * arm) < 0
    assert jams.mean() > 0.2
    assert found.found.jams[jams].all()
    fine = np.linspace(np.pi, 2 * np.pi, 10_002)[1:-1]
    safe = mu < ((gyr + (e * np.sin(fine)) ** 2) / (e * abs(np.sin(fine)) * (1 + e * np.cos(fine)))).min()
    assert safe.any()
    assert not found.found.jams[safe].any()
    assert 0 < found.to_dict()["jamming"] < 1


def test_a_range_of_two_decades_is_logarithmic():
    chosen = plane(load_scene("paper-3.1"), {"hoop.k": (1e-5, 0.1), "friction.mu": (0.1, 0.5)})
    assert chosen.across.at(np.array([0.0, 0.5, 1.0])) == pytest.approx([1e-5, 1e-3, 0.1], rel=1e-14)
    assert chosen.across.share(np.array([1e-5, 1e-3, 0.1])) == pytest.approx([0.0, 0.5, 1.0])
    assert chosen.up.at(np.array([0.5])) == pytest.approx([0.3])


@pytest.mark.parametrize(
    ("over", "said"),
    [
        ({"hoop.k": (0.1, 0.2)}, "two different keys"),
        ({"hoop.k": (0.1, 0.2), "ring.depth": (0.1, 0.2)}, "ring.depth is not a key"),
        ({"hoop.k": (0.2, 0.1), "friction.mu": (0.1, 0.2)}, "runs up"),
        ({"hoop.k": (0.1, 1.5), "friction.mu": (0.1, 0.2)}, "hoop.k = 1.5 is not possible"),
        ({"hoop.k": (0.1, 0.5), "friction.mu": (-0.1, 0.2)}, "is not possible"),
        ({"hoop.k": (0.1, float("nan")), "friction.mu": (0.1, 0.2)}, "from a number to a number"),
    ],
)
def test_what_is_no_plane_is_refused_in_a_sentence(over: dict[str, tuple[float, float]], said: str):
    with pytest.raises(SceneError, match=said) as refused:
        atlas_of("paper-3.1", over)
    assert str(refused.value).endswith((".", "below 1", "1e9"))


def test_the_command(hoop, tmp_path):
    status, out, err = hoop("study", "atlas", "--side", 16, "--json", "--out", tmp_path / "map")
    assert status == 0, err
    told = json.loads(out)
    assert told["hoops"] == 17**2
    assert told["over"] == {"hoop.k": [0.02, 0.9], "friction.mu": [0.02, 1.0]}
    assert json.loads((tmp_path / "map" / "atlas.json").read_text())["regions"] == told["regions"]
    assert (tmp_path / "map" / "atlas.png").stat().st_size > 10_000
    with np.load(tmp_path / "map" / "atlas.npz") as kept:
        assert kept["sequence"].shape == kept["impulse_share"].shape == (17, 17)
        assert (kept["hoop.k"][-1], kept["friction.mu"][-1]) == (0.9, 1.0)
        numbers = {int(number): phases for number, phases in kept["sequences"]}
        assert set(np.unique(kept["sequence_within_squares"])) == set(numbers)
    results = ["atlas.json", "atlas.npz", "atlas.png"]
    assert sorted(path.name for path in (tmp_path / "map").iterdir()) == [*results, "command.txt"]


def test_every_number_lies_inside_the_map(drawn: Atlas):
    """That of a narrow region at the edge too: "10" stands on the left of this one."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    figure = drawn.plot()
    FigureCanvasAgg(figure).draw()
    axes = figure.axes[0]
    inside = axes.get_window_extent()
    numbers = [text for text in axes.texts if text.get_text().isdecimal()]
    assert "10" in [text.get_text() for text in numbers]
    for text in numbers:
        box = text.get_window_extent()
        assert inside.x0 <= box.x0 < box.x1 <= inside.x1
        assert inside.y0 <= box.y0 < box.y1 <= inside.y1


def under(axes, x: float, y: float):
    """What a picture shows at a point of its axes, as a mouse there would be told."""
    at = SimpleNamespace(**dict(zip("xy", axes.transData.transform((x, y)), strict=True)))
    return axes.images[0].get_cursor_data(at)


@pytest.mark.parametrize("name", ["paper-3.1", "paper-3.2-k0.25", "paper-3.2-k0.75"])
def test_the_picture_has_at_a_scene_of_the_paper_what_its_motion_has(drawn: Atlas, name: str):
    """Its marker stands at its k and mu by the ticks; the colours there are those of its phases and measures."""
    scene, figure = load_scene(name), drawn.plot()
    x, y = (scene.hoop.k - 0.02) / 0.88, (scene.friction.mu - 0.02) / 0.98
    main, *panels = (axes for axes in figure.axes if axes.images)
    assert any(np.allclose(line.get_xydata(), [[x, y]]) for line in main.lines)
    for axis, low, wide in ((main.xaxis, 0.02, 0.88), (main.yaxis, 0.02, 0.98)):
        for place, label in zip(axis.get_ticklocs(), axis.get_ticklabels(), strict=True):
            assert low + wide * place == pytest.approx(float(label.get_text()), abs=1e-9)
    motion = simulate(scene)
    pulse = motion.pulses[0]
    wanted = [pulse.impulse_ratio / scene.friction.mu, pulse.friction_loss, pulse.peak_normal_force]
    for axes, value in zip(panels, wanted, strict=True):
        # of the nearest of 65 points a side: off by no more than the map changes over a square
        share = np.abs(np.gradient(np.asarray(axes.images[0].get_array(), dtype=float))).sum(axis=0)
        off = np.nanmax(share[int(y * SIDE) : int(y * SIDE) + 2, int(x * SIDE) : int(x * SIDE) + 2])
        assert float(under(axes, x, y)) == pytest.approx(value, abs=off)
    phases = [str(p.kind) for p in motion.phases if p.t_end > pulse.t_start and p.t_start < pulse.t_end]
    legend = main.get_legend()
    entries = zip(legend.get_texts(), legend.get_patches(), strict=False)
    told = {text.get_text().split("  ")[1]: patch for text, patch in entries if "  (" in text.get_text()}
    colour = np.array(told[", ".join(phases)].get_facecolor()[:3])
    assert np.asarray(under(main, x, y)[:3]) / 255 == pytest.approx(colour, abs=0.01)


def test_a_number_stands_in_the_region_whose_line_of_the_legend_has_it(drawn: Atlas):
    main = drawn.plot().axes[0]
    lines = [entry.get_text() for entry in main.get_legend().get_texts()]
    squares = drawn.found.squares
    for text in (text for text in main.texts if text.get_text().isdecimal()):
        x, y = (min(int(share * len(squares)), len(squares) - 1) for share in text.get_position())
        told = next(line for line in lines if line.startswith(f"{text.get_text()}  "))
        near = set(np.unique(squares[max(y - 4, 0) : y + 5, max(x - 4, 0) : x + 5]).tolist())
        assert any(f"  {region.phases}  " in told for region in drawn.regions if region.sequence in near)


@pytest.mark.parametrize(("release", "hatch"), [({}, "////"), ({"slip0": 1.0}, "xxx")])
def test_what_hops_and_what_jams_is_hatched_where_it_does(release, hatch):
    """From rest with spin enough; and skids released where Coulomb's law has no finite force, which jam."""
    over = {"release.omega0": (0.0, 4.0)} if not release else {"release.phi0_deg": (181.0, 359.0)}
    found = atlas_of(load_scene("paper-3.1").replace(release=release), over | {"friction.mu": (0.02, 1.5)}, side=16)
    mask = found.found.jams if release else found.found.hops
    assert mask.any()
    assert not np.array_equal(mask, mask.T)
    main = found.plot().axes[0]
    (drawn,) = (each for each in main.collections if getattr(each, "hatches", None) == [hatch])
    share = np.linspace(0, 1, 17)
    inside = np.array([[any(path.contains_point((x, y)) for path in drawn.get_paths()) for x in share] for y in share])
    within = (slice(1, -1), slice(1, -1))  # points of the frame are on the edge of what is filled
    assert np.array_equal(inside[within], mask[within])


@pytest.mark.parametrize("over", ["hoop.k=0.1", "hoop.k=a:b", "hoop.k=0.1:0.2:0.3", "hoop.k=0.1:0.2"])
def test_the_command_refuses_in_a_sentence(hoop, tmp_path, over: str):
    status, out, err = hoop("study", "atlas", "--over", over, "--out", tmp_path / "map")
    assert (status, out) == (2, "")
    assert is_one_sentence(err)
    assert not (tmp_path / "map").exists()


def test_the_title_says_the_units_of_a_throw():
    """A hoop of 0.5 m that is thrown at 8.86 rad/s, which is 2 sqrt(g/R), and 4.43 m/s, which is 2 sqrt(g R)."""
    g, R = 9.81, 0.5
    scene = load_scene("paper-3.1").replace(hoop={"R": R, "m": 1.0, "g": g})
    scene = scene.replace(release={"omega0": 2 * (g / R) ** 0.5, "slip0": 2 * (g * R) ** 0.5})
    told = fixed(Drawn(plane(scene, {"hoop.k": (0.1, 0.2), "friction.mu": (0.1, 0.2)}), None, ()))
    assert r"\omega_0 = 2\,\sqrt{g/R}$" in told
    assert r"v_0 = 2\,\sqrt{gR}$" in told


def test_the_title_says_the_friction_that_was_run():
    """Of a scene that slips without friction mu = 0 throughout; and what a landing gives back."""
    smooth = load_scene("paper-3.1").replace(friction={"mu_s": 0.4, "mu": 0.0}, landing={"restitution": 0.5})
    over = {"friction.mu_s": (0.1, 1.0), "hoop.k": (0.05, 0.5)}
    told = fixed(Drawn(plane(smooth, over), None, ()))
    assert r"$\mu = 0$" in told
    assert r"\mu_s/\mu" not in told
    assert "restitution $0.5$" in told
    told = fixed(Drawn(plane(smooth.replace(friction={"mu": 0.3}), over), None, ()))
    assert r"\mu_s/\mu = 1.333" in told


def test_sequences_too_small_for_the_table_are_counted(drawn: Atlas):
    tiny = [Region(10**6 + n, "spin", share) for n, share in enumerate((1e-5, 1e-6))]
    sheet, *said = atlas_sheets(replace(drawn, regions=(*drawn.regions, *tiny)))
    listed = len(sheet.keys[0].cells)
    told = " ".join(map(str, said))
    assert f"{len(drawn.regions) + 2 - listed} more sequences" in told
    assert "atlas.json has all" in told


def test_the_help_names_every_key(hoop):
    status, out, _ = hoop("study", "atlas", "-h")
    assert status == 0
    assert all(key in " ".join(out.split()) for key in SYMBOLS)


@pytest.mark.parametrize("side", [0, -5, 20.5, float("nan"), "20"])
def test_squares_that_cannot_be_counted(side):
    with pytest.raises(SceneError, match=r"side = .* whole number of squares"):
        atlas_of("paper-3.1", {"hoop.k": (0.1, 0.9), "friction.mu": (0.1, 1.0)}, side=side)


def test_a_field_that_is_bilinear_is_known_from_corners_and_centres():
    """To the last bit: no cell of it is divided, 5 x 5 corners and 4 x 4 centres are all runs."""

    def run(u, v):
        f, none = 3 * u - 2 * v + u * v, np.zeros(len(u), bool)
        return Seen(np.full(len(u), 7), f, f, f, none.astype(int), none)

    assert refined(run, SIDE, 1e-3).runs == 5**2 + 4**2

"""A motion in a session or a notebook: curves, tables, a few lines."""

from __future__ import annotations

import copy
import dataclasses
import json
import pickle
import re
import subprocess
import sys
from math import inf, pi
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pytest

from rigid import (
    Friction,
    Hoop,
    Pulse,
    Release,
    Run,
    Scene,
    SceneError,
    States,
    inception_mu_s,
    load_scene,
    rolling_mu_s,
    simulate,
    simulate_batch,
)
from rigid.output.axes import label
from rigid.output.units import Unit, units_of

mpl.use("Agg")
ROOT = Path(__file__).parents[2]
HEAVY = load_scene("paper-3.2-k0.25").replace(hoop={"R": 0.4, "m": 0.2, "g": 9.81})


@pytest.fixture(scope="module")
def motion():
    return simulate("paper-3.1")


@pytest.fixture(autouse=True)
def closed():
    yield
    from matplotlib import pyplot

    pyplot.close("all")


def curve(axes):
    return axes.lines[-1].get_xydata()


def test_curves_are_the_states(motion):
    """Every point drawn is a state; between them N is straight to two thousandths of its range."""
    axes = motion.plot("normal_force", "energy")
    assert len(axes) == 2
    t, normal = curve(axes[0]).T
    assert (t[0], t[-1]) == (0.0, motion.t_end)
    assert (normal == motion.at(t).normal_force).all()
    middle = (t[1:] + t[:-1]) / 2
    jump = np.diff(t) < 1e-10  # both sides of one
    off = np.abs(motion.at(middle).normal_force - (normal[1:] + normal[:-1]) / 2)[~jump]
    assert off.max() <= 2e-3 * np.ptp(normal)
    assert normal.max() == pytest.approx(motion.pulses[0].peak_normal_force, rel=2e-3)
    assert "mg" in axes[0].get_ylabel()


def test_over_the_angle_and_on_given_axes(motion):
    from matplotlib import pyplot

    _, axes = pyplot.subplots(3)
    drawn = motion.plot(over="phi", axes=axes)
    assert list(drawn) == list(axes)
    phi = curve(drawn[0])[:, 0]
    # a turn lies between two of the 129 times at least, where phi = phi_max - alpha (dt)^2/2
    assert phi.max() == pytest.approx(motion.turns[0].phi, abs=(motion.t_end / 128) ** 2)
    assert "varphi" in drawn[-1].get_xlabel()
    assert len(drawn[0].lines) == 1 + len([phase for phase in motion.phases if phase.kind != "roll"])
    assert not drawn[0].get_legend()
    with pytest.raises(ValueError, match="3 quantities need as many axes"):
        motion.plot(axes=axes[:2])
    with pytest.raises(ValueError, match="'speed' is not a quantity of a motion: known are t, phi"):
        motion.plot("speed")


def bands(axes):
    """Points of the shades along a curve, by what the legend calls their colour."""
    named = dict(zip(*reversed(axes.get_legend_handles_labels()), strict=True))
    return {
        word: np.vstack([line.get_xydata() for line in axes.lines[:-1] if line.get_color() == one.get_color()])
        for word, one in named.items()
    }


def test_shades_over_the_angle_where_the_hoop_comes_back(motion):
    """It skids on through its turn, back over angles at which it came spinning: F = mu N, v < 0 where it spins, and
    F = -mu N, v > 0 where it skids, there and back."""
    mu, turn = motion.scene.friction.mu, motion.turns[0].phi
    axes = motion.plot("slip_velocity", "friction_force", over="phi")
    (speed, friction), skid = map(bands, axes), next(p for p in motion.phases if p.kind == "skid")
    assert list(speed) == ["spin", "skid"]
    assert (speed["spin"][1:, 1] < 0).all()
    assert (speed["skid"][1:, 1] > 0).all()
    normal = bands(motion.plot("normal_force", over="phi")[0])
    for word, way in (("spin", mu), ("skid", -mu)):
        np.testing.assert_allclose(friction[word][1:, 1], way * normal[word][1:, 1], rtol=1e-9)
    reached = speed["skid"][:, 0]
    assert reached[0] == pytest.approx(skid.phi_start, abs=1e-9)
    assert reached.max() == pytest.approx(turn, abs=(motion.t_end / 128) ** 2)
    assert reached[-1] == pytest.approx(skid.phi_end, abs=1e-9)


@pytest.mark.parametrize("over", ["t", "phi"])
def test_shades_are_named_above_the_panels(motion, over):
    axes = motion.plot(over=over)
    figure = axes[0].figure
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()] == ["spin", "skid"]
    figure.canvas.draw()
    assert legend.get_window_extent().y0 > axes[0].get_window_extent().y1


def test_a_pulse_draws_itself(motion):
    pulse = motion.pulses[0]
    axes = pulse.plot("phi", "normal_force")
    t, phi = curve(axes[0]).T
    assert (t[0], t[-1]) == (pulse.t_start, pulse.t_end)
    assert phi[0] < pi < phi[-1]
    assert curve(axes[1])[:, 1].max() == pytest.approx(pulse.peak_normal_force, rel=2e-3)
    assert simulate(HEAVY).pulses[0].plot("normal_force")[0].get_ylabel().endswith("$N$ (N)")
    bare = Pulse(**{name: value for name, value in pulse.to_dict().items() if name != "impulse_ratio"})
    assert bare == pulse
    with pytest.raises(ValueError, match="belongs to no motion"):
        bare.plot()


def test_a_pulse_of_a_motion_that_comes_again():
    """What comes round a thousand times is kept once: the last pulse is drawn where it is."""
    smooth = simulate(Scene(Hoop(0.3), Friction(0, 0), Release(phi0_deg=10), Run(turns=200)))
    last = smooth.pulses[-1]
    t, normal = curve(last.plot("normal_force")[0]).T
    assert (t[0], t[-1]) == (last.t_start, last.t_end)
    # 1 at both edges of the pulse, where N = M g
    assert normal[[0, -1]] == pytest.approx(1, abs=1e-6)


def test_a_table_of_states(motion):
    table = motion.to_dataframe()
    states = motion.at(table["t"].to_numpy())
    assert (table["friction_force"] == states.friction_force).all()
    assert list(table["phase"].unique()) == ["roll", "spin", "skid"]
    assert list(motion.to_dataframe([0.0, 1.0])["t"]) == [0.0, 1.0]
    assert table.attrs["units"] == {name: motion.units[name] for name in table.columns[:-1]}
    assert simulate(HEAVY).to_dataframe([0.0]).attrs["units"]["friction_force"] == "N"
    assert len(motion.to_dataframe(0.5)) == 1
    with pytest.raises(ValueError, match="times must be one-dimensional"):
        motion.to_dataframe([[1, 2]])
    for t in (np.ma.array([1.0, 2.0], mask=[False, True]), [[1, 2], [3]], "1"):
        with pytest.raises(ValueError, match=r"^times = .* is not possible: the motion goes from 0 to "):
            motion.to_dataframe(t)


@pytest.mark.parametrize("span", [(3, 1), (1e9,), (0.0, np.nan)])
def test_times_run_upward(motion, span):
    with pytest.raises(ValueError, match="they run upward"):
        motion.times(*span)
    assert motion.times(1, 1).dtype == float


@pytest.mark.parametrize(("start", "end"), [("x", 2), (None, None), ([[1, 2], [3]], 2), (0, [1, 2]), (0, "x")])
def test_each_end_of_the_times_is_a_number(motion, start, end):
    with pytest.raises(ValueError, match=r"^Times from .* to .* are not possible: each of the two is a number"):
        motion.times(start, end)


def test_thousands_of_pulses_are_sampled_in_a_few_calls():
    """A hoop that rolls over and over slips a little in every pulse; finding each lowest point took minutes."""
    long, asked = simulate(Scene(Hoop(0.9), Friction(1, 1), Release(phi0_deg=0, omega0=4))), []

    def counted(t, side):
        asked.append(len(t))
        return long.sample(t, side)

    t = dataclasses.replace(long, sample=counted).times()
    assert len(long.pulses) > 1000
    assert len(asked) < 20
    assert len(t) < 20_000 + 2.5 * len(long.phases)  # both sides of every jump, and as many as are allowed besides
    for jump in [phase.t_end for phase in long.phases[:-1:100]]:
        assert np.abs(t[t < jump] - jump).min() < 1e-11 * long.t_end
        assert np.abs(t[t > jump] - jump).min() < 1e-11 * long.t_end
    frame = long.to_dataframe(t[::50])
    assert frame["phase"].tolist() == [str(long.phase_at(one).kind) for one in t[::50]]


@pytest.mark.parametrize(
    ("t", "told"),
    [
        ("a", "'a'"), (1j, "1j"), (True, "True"), (None, "None"), ([0, None], "[0, None]"), ([0, 1e9], "1000000000.0"),
        ([1, [2]], "[1, [2]]"), (np.datetime64("2020"), "datetime.date(2020, 1, 1)"), ("1.0", "'1.0'"),
    ],
)  # fmt: skip
def test_what_is_no_time_of_the_motion_is_told_by_name(motion, t, told):
    words = f"times = {told} is not possible: the motion goes from 0 to "
    with pytest.raises(ValueError, match=f"^{re.escape(words)}") as caught:
        motion.at(t)
    # all up to what is told is possible
    assert motion.at(float(str(caught.value).removeprefix(words).removesuffix("."))).t <= motion.t_end


def test_times_and_sides_that_there_are_not(motion):
    for t in (-5.0, 500.0, np.nan):
        for ask in (motion.at, motion.phase_at):
            with pytest.raises(ValueError, match=rf"^times = {t} is not possible: the motion goes from 0 to "):
                ask(t)
    for ask in (motion.at, motion.phase_at):
        with pytest.raises(ValueError, match="side must be 'left' or 'right', not 'middle'"):
            ask(1.0, "middle")


def test_a_table_of_a_batch():
    """A row for each pulse; measures as the array has them, and as one scene alone has them."""
    scenes = [load_scene("paper-3.1"), load_scene("paper-3.1").replace(hoop={"k": 0.97}), HEAVY]
    batch = simulate_batch(scenes)
    table = batch.to_dataframe()
    assert table.index.names == ["scene", "pulse"]
    assert [scene for scene, _ in table.index] == sorted(scene for scene, _ in table.index)
    counts = np.minimum(batch.pulse_count, 2)
    assert [len(table.loc[scene]) for scene in range(3)] == list(np.maximum(counts, 1))
    alone = simulate(scenes[0]).pulses
    assert table.loc[(0, 2), "impulse_ratio"] == pytest.approx(alone[1].impulse_ratio, rel=1e-12)
    assert not table["cut"].any()
    nothing = simulate_batch(scenes, t_end=1e-3).to_dataframe()
    assert list(nothing.index) == [(0, 0), (1, 0), (2, 0)]
    assert nothing["normal_impulse"].isna().all()
    assert (nothing["ended"] == "the time to run is over").all()


def test_a_few_lines_say_what_it_is(motion):
    many = simulate(Scene(Hoop(0.1), Friction(0, 0), Release(phi0_deg=10), Run(turns=1000)))
    batch = simulate_batch([load_scene("paper-3.1")] * 50)
    for thing in (motion, many, batch):
        lines = repr(thing).splitlines()
        assert len(lines) <= 24
        assert max(map(len, lines)) <= 100
        html = thing._repr_html_()
        assert html.count("<table>") == html.count("</table>") >= 1
    assert "roll, spin, roll, skid" in repr(motion)
    assert "0.150841" in repr(motion)
    assert "1000: " in repr(many)
    assert "50: the last turn" in repr(batch)
    odd = copy.copy(motion)
    object.__setattr__(odd, "ended", "a < b & c")
    assert "a &lt; b &amp; c" in odd._repr_html_()


def test_what_draws_is_not_printed_pickled_twice_or_compared(motion):
    assert "sample" not in json.dumps(motion.to_dict())
    again = pickle.loads(pickle.dumps(motion))
    assert again == motion
    assert again.pulses[0].sample is again.sample
    assert "sample" not in repr(motion.pulses[0])


def test_pictures_and_tables_are_loaded_where_they_are_used():
    line = (
        "import sys, rigid; m = rigid.simulate('paper-3.1'); repr(m), m._repr_html_(), m.times();"
        "assert not set(sys.modules) & {'matplotlib', 'pandas', 'scipy', 'numba'}"
    )
    subprocess.run([sys.executable, "-c", line], cwd=ROOT, check=True)


def test_a_batch_tells_the_phases_of_each_pulse():
    """Those of the motion that last within the pulse, and the impacts inside it: jams and landings."""
    rng = np.random.default_rng(20091)
    n = 150
    mu = rng.uniform(0.02, 1.0, n)
    hoops = {
        "k": 10 ** rng.uniform(-4, -0.05, n), "r": rng.uniform(1, 1.3, n), "mass_ratio": rng.choice([0, 0.1, 1.0], n),
        "mu": mu, "mu_s": mu * rng.uniform(1, 1.5, n), "phi0": rng.uniform(0.05, 2.0, n),
        "omega0": rng.normal(size=n) * rng.choice([0, 2], n), "slip0": rng.normal(size=n) * rng.choice([0, 2], n),
    }  # fmt: skip
    batch = simulate_batch(hoops, turns=2, pulses=2)
    seen = set()
    for i in range(n):
        value = {name: float(column[i]) for name, column in hoops.items()}
        motion = simulate(
            Scene(
                Hoop(value["k"], value["r"], value["mass_ratio"]),
                Friction(value["mu_s"], value["mu"]),
                Release(value["phi0"], value["omega0"], value["slip0"]),
                Run(turns=2),
            )
        )
        assert batch.hop_count[i] == sum(phase.kind == "flight" for phase in motion.phases)
        for j, pulse in enumerate(motion.pulses[:2]):
            start, end = pulse.t_start, pulse.t_end
            within = tuple(
                phase.kind
                for phase in motion.phases
                if (phase.t_start < end and phase.t_end > start) or start < phase.t_start == phase.t_end <= end
            )
            assert batch.phases(i, j) == within
            seen.add(within)
        assert all(batch.phases(i, j) == () for j in range(len(motion.pulses), 2))
    assert len(seen) > 10
    assert any("impact" in phases for phases in seen)


def test_the_unit_on_an_axis_is_the_one_that_the_quantity_says():
    """A symbol over its unit, or its SI unit behind it; an angle is in radians whatever the scene."""
    for name, unit in units_of(States).items():
        said = label(name, dimensionless=True)
        assert said.endswith("(rad)" if unit is Unit.NUMBER else (f"/{unit.formula}$", f"/({unit.formula})$")), said
        said = label(name, dimensionless=False)
        assert said.endswith("$ (rad)" if unit is Unit.NUMBER else f"$ ({unit.label(HEAVY)})"), said


def test_states_are_the_same_where_all_their_numbers_are(motion):
    """Unknown ones too: of a point mass that skims there is no angular acceleration."""
    times = np.array([0.0, 1.0, 5.7])
    one, other = motion.at(times), motion.at(times)
    assert one == other
    assert hash(one) == hash(other)
    assert one != motion.at(times[:2])
    assert one != motion.at(times + 1e-9)
    unknown = dataclasses.replace(one, alpha=np.array([0.0, np.nan, 1.0]))
    assert unknown == dataclasses.replace(other, alpha=np.array([0.0, np.nan, 1.0]))
    assert unknown != one
    assert motion.at(1.0) == motion.at(1.0)


@pytest.mark.parametrize("scene", ["paper-3.1", HEAVY])
def test_states_have_the_shape_of_their_times(scene):
    """A number at one time, which JSON takes, of every field alike: some were arrays without axes."""
    found = simulate(scene)
    middle = found.t_end / 2
    for t in (middle, np.float64(middle), np.array(middle)):
        now = dataclasses.asdict(found.at(t))
        assert {type(value) for value in now.values()} == {np.float64}
        assert json.loads(json.dumps(now)) == now
    for shape in ((1,), (0,), (2, 3)):
        for name, value in dataclasses.asdict(found.at(np.full(shape, middle))).items():
            assert type(value) is np.ndarray
            assert value.shape == shape
            assert (value == now[name]).all()


def test_a_pulse_in_a_few_lines(motion):
    """Its numbers with the units of its scene, if it belongs to a motion, and with none if not."""
    pulse, heavy = motion.pulses[0], simulate(HEAVY).pulses[0]
    for each in (pulse, heavy):
        lines = str(each).splitlines()
        assert len(lines) <= 6
        assert max(map(len, lines)) <= 100
        assert f"J_F/J_N = {each.impulse_ratio:.6g}" in str(each)
    assert f"J_F = {pulse.friction_impulse:.6g} m sqrt(gR);" in str(pulse)
    assert f"J_F = {heavy.friction_impulse:.6g} N s;" in str(heavy)
    assert f"J_F = {heavy.friction_impulse:.6g};" in str(dataclasses.replace(heavy, sample=None))
    assert "restitution" in str(pulse)
    assert "(cut)" not in str(pulse)
    cut = str(dataclasses.replace(pulse, cut=True, newton_restitution=np.nan))
    assert "(cut)" in cut
    assert "nan" not in cut


def test_what_is_asked_in_the_wrong_words(motion):
    with pytest.raises(ValueError, match="is not a quantity of a motion"):
        motion.plot(["normal_force", "energy"])
    with pytest.raises(ValueError, match="Figure is not possible: what is drawn on are matplotlib Axes"):
        motion.plot("energy", axes=mpl.figure.Figure())
    with pytest.raises(ValueError, match="one time"):
        motion.phase_at([1, 2])
    with pytest.raises(ValueError, match=r"^times = .* is not possible"):
        motion.phase_at([[1, 2], [3]])
    with pytest.raises(SceneError, match=r"aloft = 1\.0 is not possible"):
        simulate("paper-3.1", 1.0)
    with pytest.raises(SceneError, match="it must be a Release"):
        rolling_mu_s(Hoop(0.1), 0.2)


def test_upside_down_it_stands_on_any_floor():
    """At rest on its top the disk needs no friction; a breath beside it rolls to where N vanishes."""
    assert rolling_mu_s(Hoop(0.1), Release(0.0)) == inception_mu_s(Hoop(0.1), 0.0) == 0
    assert rolling_mu_s(Hoop(0.1), Release(1e-9)) == inf


def test_what_is_masked_is_no_number():
    k = np.ma.array([0.1, 0.2], mask=[False, True])
    with pytest.raises(SceneError, match="nan"):
        simulate_batch({"k": k, "mu_s": 0.35, "mu": 0.3, "phi0": 0.17})


def test_the_end_is_as_near_in_any_unit():
    motion = simulate(HEAVY.replace(hoop={"R": 1e-30}))
    with pytest.raises(ValueError, match="the motion goes from 0 to"):
        motion.at(2 * motion.t_end)


def test_a_scene_comes_through_a_pipe():
    text = (ROOT / "rigid/scenes/paper-3.1.toml").read_text()
    run = [sys.executable, "-c", "import rigid; print(rigid.load_scene('/dev/stdin') == rigid.load_scene('paper-3.1'))"]
    if not Path("/dev/stdin").exists():
        pytest.skip("no /dev/stdin here")
    done = subprocess.run(run, input=text, capture_output=True, text=True, check=True, cwd=ROOT)
    assert done.stdout == "True\n"

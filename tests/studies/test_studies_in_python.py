"""Studies in a session or a notebook."""

from __future__ import annotations

import dataclasses
import inspect
import re

import matplotlib as mpl
import numpy as np
import pytest

import flexible
import meshes
import rigid
import studies
from rigid import SceneError, load_scene
from rigid.output.file import version
from studies import Ladder, StudyError, limit_study, pool, run_sweep, stiffness_study, sweep_from_dict

mpl.use("Agg")


@pytest.fixture(scope="module")
def study():
    """A hoop that tends to the rigid one at a rate that is known."""
    return stiffness_study("paper-3.3-massless", Ladder("both", 1e7, 1e12, 6), solver="third_solver:softened")


@pytest.mark.parametrize("workers", [-1, 0, "a", 1.5, 10_000])
def test_workers_that_are_no_number_of_them_are_refused(workers):
    with pytest.raises(SceneError, match=r"^workers = .* whole number from 1 to 1024"), pool(workers):
        pass


@pytest.mark.parametrize("place", [3, 0, pool(2)])
@pytest.mark.parametrize("run", [stiffness_study, limit_study, studies.hop_study, run_sweep])
def test_a_pool_that_is_none_is_refused_before_anything_runs(run, place, tmp_path, monkeypatch):
    monkeypatch.setattr("studies.limit.study.followed", lambda scene: pytest.fail("it was solved"))
    what = "paper-3.3-massless" if run is not run_sweep else {"sweep": {"scene": "paper-3.1"}, "hoop": {"k": [0.1]}}
    with pytest.raises(StudyError, match=r"^pool = .* is not possible: it is what `with studies\.pool"):
        run(what, pool=place, out=tmp_path / "out")
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("address", [3, "", "nowhere"])
def test_what_is_no_address_of_a_scheduler_is_refused(address):
    with pytest.raises(StudyError, match=f"no Dask scheduler at {address}: it takes host and port"), pool(2, address):
        pass


@pytest.mark.parametrize("rate", [float("nan"), float("inf"), -1.0, 0.0, "a", [1.0]])
def test_a_rate_that_is_none_is_refused_before_anything_runs(tmp_path, rate):
    with pytest.raises(SceneError, match=r"^rate = .* is not possible"):
        stiffness_study("paper-3.3-massless", rate=rate, out=tmp_path)
    assert not list(tmp_path.iterdir())


def test_a_study_draws_its_distance(study):
    from matplotlib import pyplot

    axes = study.plot()
    assert len(axes) == 2
    limit = study.limits["impulse_ratio"]
    points = [line for line in axes[0].lines if line.get_label() in ("above the rigid value", "below the rigid value")]
    drawn = {round(x): y for line in points for x, y in zip(*line.get_data(), strict=True)}
    for rung in study.rungs:
        away = abs(rung.measure("impulse_ratio") - limit.rigid)
        assert drawn[round(rung.stiffness)] == pytest.approx(away, rel=1e-12)
    assert len(study.plot("normal_impulse")) == 1
    with pytest.raises(ValueError, match="2 measures need as many axes"):
        study.plot(axes=pyplot.subplots(3)[1])
    pyplot.close("all")


def test_a_point_is_called_above_the_rigid_value_where_it_is(study):
    """The loss of the third solver is too small and its impulse too large, which the ratio has with its sign."""
    from matplotlib import pyplot

    for axes, (name, limit) in zip(study.plot("impulse_ratio", "friction_loss"), study.limits.items(), strict=False):
        told = {line.get_label(): len(line.get_xdata()) for line in axes.lines}
        above = sum(rung.measure(name) > limit.rigid for rung in study.rungs)
        assert told.get("above the rigid value", 0) == above
        assert told.get("below the rigid value", 0) == len(study.rungs) - above
    pyplot.close("all")


def test_a_measure_that_a_rung_has_not_is_told_with_those_that_it_has(study):
    for of in (study.rungs[0].measure, study.rungs[0].error):
        with pytest.raises(ValueError, match=r"^'my_time' is not a measure of this study: known are normal_impulse, "):
            of("my_time")


def test_a_study_as_a_table_and_in_a_few_lines(study):
    table = study.to_dataframe()
    assert list(table["contact_stiffness"]) == pytest.approx(list(np.geomspace(1e7, 1e12, 6)))
    assert list(table["impulse_ratio"]) == [rung.measure("impulse_ratio") for rung in study.rungs]
    lines = repr(study).splitlines()
    assert len(lines) <= 24
    assert max(map(len, lines)) <= 100
    assert "<td>1e+12</td>" in study._repr_html_()


def test_the_limit_solved_in_a_few_lines():
    found = limit_study("paper-3.3-massless", foundations=())
    lines = repr(found).splitlines()
    assert len(lines) <= 24
    assert max(map(len, lines)) <= 100
    term = found.prediction.terms["impulse_ratio"]
    assert f"{term.limit:.6g} + {term.coefficient:.4g} x\n" in repr(found)
    assert "foundation^(-1/3)" in found._repr_html_()


def test_a_sweep_needs_no_pool():
    data = {"sweep": {"scene": "paper-3.1", "solvers": ["rigid"]}, "hoop": {"k": [0.1, 0.25]}}
    table = run_sweep(sweep_from_dict(data))
    ratios = [
        rigid.simulate(load_scene("paper-3.1").replace(hoop={"k": k})).pulses[0].impulse_ratio for k in (0.1, 0.25)
    ]
    frame = table.to_dataframe()
    assert list(frame[frame["pulse"] == 1]["impulse_ratio"]) == ratios
    assert len(repr(table)) < 60
    assert "impulse_ratio" in table._repr_html_()


def test_a_sweep_is_what_says_so(tmp_path):
    """A dict, a path, its text or a sweep, as a scene is for ``rigid.simulate``."""
    data = {"sweep": {"scene": "paper-3.1", "solvers": ["rigid"]}, "hoop": {"k": [0.1, 0.25]}}
    file = tmp_path / "two.toml"
    file.write_text('[sweep]\nscene = "paper-3.1"\nsolvers = ["rigid"]\n[hoop]\nk = [0.1, 0.25]\n')
    first, *others = (run_sweep(source).to_csv() for source in (data, file, str(file), sweep_from_dict(data)))
    assert others == [first] * 3
    with pytest.raises(rigid.SceneError, match=r"^17 is not a sweep"):
        run_sweep(17)
    with pytest.raises(rigid.SceneError, match=r"nowhere\.toml"):
        run_sweep("nowhere.toml")


@pytest.mark.parametrize("package", [rigid, meshes, flexible, studies])
def test_every_package_tells_its_version_and_that_it_is_typed(package):
    from importlib.resources import files

    assert package.__version__ == version()
    assert "__version__" in dir(package)
    assert (files(package) / "py.typed").is_file()
    with pytest.raises(AttributeError, match="has no attribute 'nothing'"):
        package.nothing  # noqa: B018


SWEPT = {"hoop": {"k": [0.1]}, "friction": {"mu_s": 0.35, "mu": 0.3}, "release": {"phi0_deg": 10}}


@pytest.mark.parametrize("solvers", ["flexibel", ["rigid", "x"], [rigid.simulate], [3], None])
def test_a_solver_that_is_none_is_refused_before_anything_runs(solvers):
    with pytest.raises(StudyError, match="is not a solver"):
        sweep_from_dict(SWEPT, solvers=solvers)


def test_a_solver_named_twice_is_one():
    assert sweep_from_dict(SWEPT, solvers=["rigid", "rigid"]).cases == 1


@pytest.mark.parametrize("solver", [rigid.simulate, None, "rigidd"])
def test_a_study_of_no_solver(solver):
    with pytest.raises(StudyError, match="is not a solver"):
        stiffness_study("paper-3.3-massless", solver=solver)


def test_what_is_asked_in_the_wrong_words(study):
    with pytest.raises(ValueError, match="'nope' is not a measure of this study: known are impulse_ratio"):
        study.plot("nope")
    with pytest.raises(TypeError, match=r"unit = 's' is not possible: it is one of studies.Unit: .*TIME"):
        studies.measure("$q$", "s")
    with pytest.raises(SceneError, match=r"^17 is not a scene"):
        studies.hop_study(17)
    with pytest.raises(SceneError, match="are of no key"):
        studies.HopMap(load_scene("paper-3.3-heavier"), (10.0,), values=(0.1, 0.2))
    for over in (
        {"hoop.k": (0.1, 0.2), "friction.mu": 0.3},
        None,
        {"hoop.k": (0.1, 0.2, 0.3), "friction.mu": (0.1, 1)},
    ):
        with pytest.raises(SceneError, match=r"over = .* both ends"):
            studies.atlas_of(over=over)
    with pytest.raises(SceneError, match="from 1 to 8192"):
        studies.atlas_of(side=10**9)
    with pytest.raises(ValueError, match="a force and its times"):
        meshes.frame_times(0, 1, 5, normal_force=[1, 2])


@pytest.mark.parametrize(
    "given", ["1e10", None, {"S": 1e10}, [1e10, "a"], [[1e10]], [1e10, -1.0], float("nan"), True, iter([1e10])]
)
@pytest.mark.parametrize("name", ["foundations", "flexible"])
def test_foundations_that_are_none_are_refused_in_a_sentence(name, given):
    with pytest.raises(SceneError, match=rf"^{name} = .* is not possible: .*\.$"):
        limit_study("paper-3.3-massless", **{name: given})


def test_a_single_foundation_is_one():
    found = limit_study("paper-3.3-massless", foundations=np.float64(1e10))
    assert [sight.foundation for sight in found.sights] == [1e10]


@pytest.mark.parametrize(
    ("settings", "told"),
    [
        ({"stiffness": 10.0}, "stiffness = 10.0 is not possible: it lists what is rolled"),
        ({"stiffness": [[1.0], [1.0, 2.0]]}, "ring.bending_stiffness = .1.0. is not possible"),
        ({"stiffness": {1.0: 2.0}}, "stiffness = .* it lists what is rolled"),
        ({"second": "hoop.k", "values": 0.1}, "values = 0.1 is not possible: it lists what is rolled"),
        ({"second": "hoop.k", "values": [[0.1]]}, "hoop.k = .0.1. is not possible"),
        ({"second": "hoop.k"}, "hoop.k = None is not possible"),
        ({"second": 5, "values": [0.1]}, "second = 5 is not possible: it is the key"),
    ],
)
def test_a_map_lists_what_is_rolled(settings, told):
    with pytest.raises(SceneError, match=f"^{told}"):
        studies.HopMap("paper-3.3-heavier", **settings)


def test_a_sweep_is_loaded_from_a_path():
    with pytest.raises(SceneError, match=r"^5 is not a sweep: that is the path of a TOML file\.$"):
        studies.load_sweep(5)


@pytest.mark.parametrize("exponents", [1 / 3, [], ["a"], [-1.0]])
def test_exponents_that_are_no_rates(exponents):
    with pytest.raises(ValueError, match=r"^exponents = .* is not possible: they are a list of rates"):
        studies.limit_of([1e6, 1e7, 1e8], [1.0, 1.1, 1.2], 1.3, exponents=exponents)


@pytest.mark.parametrize(("s", "y"), [(["a"], [1.0]), ([1e6], "b"), ([[1e6], [1e7, 1e8]], [1.0])])
def test_cases_that_are_no_numbers(s, y):
    with pytest.raises(ValueError, match=r"s, y and error of .* are not possible: (they are lists|there is one)"):
        studies.limit_of(s, y, 1.3)


def of_the_command(name):
    """Its options as they are where none is given."""
    from studies.cli.hoop import hoop

    command = hoop
    for word in name.split():
        command = command.get_command(None, word)
    return command.make_context(name, ["paper-3.3-heavier"]).params


def test_a_ladder_without_words_is_that_of_the_command():
    """The ends that it does not say are the scene's own stiffness, of what it raises, by the same factors."""
    asked = of_the_command("study stiffness")
    assert Ladder() == Ladder(asked["along"], asked["low"], asked["high"], asked["count"])
    scene = load_scene("paper-3.3-massless")
    for along, own in (("both", scene.contact.stiffness), ("bending", scene.ring.bending_stiffness)):
        stiffness = Ladder(along).around(scene).stiffness
        assert len(stiffness) == 9
        assert stiffness[[0, -1]] / own == pytest.approx([1e-2, 1e4])
        raised = [rung.ring.bending_stiffness for rung in Ladder(along, count=3).rungs(scene)]
        assert raised == pytest.approx(scene.ring.bending_stiffness * np.array([1e-2, 10, 1e4]))
    ends = Ladder(low=1e7).around(scene)
    assert (ends.low, ends.high) == (1e7, scene.contact.stiffness * 1e4)
    assert ends.around("paper-3.1") == ends
    with pytest.raises(SceneError, match=r"ladder\.around\(scene\)"):
        Ladder(count=2).stiffness  # noqa: B018
    with pytest.raises(SceneError, match="it runs upward"):
        Ladder(low=1e300).around(scene)
    study = stiffness_study(scene, Ladder(count=2), solver="third_solver:softened")
    assert study.ladder == Ladder(count=2).around(scene)


def test_studies_ask_for_the_same_in_the_same_words():
    """A patch's damping is the scene's in both; what of a command has a name in Python has the same there."""
    both = [set(inspect.signature(study).parameters) for study in (stiffness_study, limit_study)]
    assert {"scene", "pool", "out", "progress"} <= both[0] & both[1]
    assert not any({"damping", "law"} & names for names in both)
    assert "rate" in both[0]
    assert "rate" in of_the_command("study stiffness")


@pytest.mark.parametrize("name", [name for name in studies.__all__ if isinstance(getattr(studies, name), type)])
def test_what_one_gets_says_in_its_help_what_it_holds(name):
    """Strings after fields are for readers of the source and of the site: ``help()`` has the class's own text alone."""
    given = getattr(studies, name)
    if dataclasses.is_dataclass(given):
        needed = [each.name for each in dataclasses.fields(given) if each.default is each.default_factory]
        assert [each for each in needed if not re.search(rf"``{each}``|^{each} :", inspect.getdoc(given), re.M)] == []


class Asked(Exception):
    """Instead of a roll."""


def test_a_hop_study_takes_a_scene(monkeypatch):
    """The map that it rolls is that of the command: what neither says is said once."""
    from studies.cli.hop import map_of

    def ask(cases, *_, **__):
        raise Asked([case.scene for case in cases])

    monkeypatch.setattr("studies.hop.study.run_cases", ask)
    scene, rolled = load_scene("paper-3.3-heavier"), []
    left_out = {name: of_the_command("study hop")[name] for name in ("bisections", "rtol", "level")}
    for asked in ("paper-3.3-heavier", scene, studies.HopMap(scene), map_of(scene, (), **left_out)):
        with pytest.raises(Asked) as caught:
            studies.hop_study(asked)
        rolled.append(caught.value.args[0])
    assert rolled == [rolled[0]] * 4
    stiffness = [each.ring.bending_stiffness for each in rolled[0]]
    assert stiffness == pytest.approx(np.geomspace(0.5, 1e4, 24))


def test_an_error_below_zero_is_none():
    with pytest.raises(ValueError, match=r"error = -0\.1"):
        studies.limit_of([1e6, 1e7, 1e8], [1.0, 1.1, 1.2], 1.3, error=[0.1, -0.1, 0.1])


def test_stresses_are_arrays_or_lists():
    assert meshes.von_mises([[3.0, 0.0, 0.0], [0.0, 0.0, 1.0]]) == pytest.approx([3.0, 3**0.5])
    ring = meshes.ring_mesh(0.9, 1.0, 60)
    with pytest.raises(ValueError, match="one stress for each of"):
        meshes.bending_stress(ring, np.zeros((len(ring.theta), 3)))


@pytest.mark.parametrize("shape", [(), (0,), (4,), (3, 7), (2, 7, 3)])
def test_stresses_of_no_three_components_are_refused(shape):
    """Of more axes the first two would come back exchanged."""
    with pytest.raises(ValueError, match=r"stress of shape \(.*\) is not possible: a row is the components 11, 22 and"):
        meshes.von_mises(np.zeros(shape))


def test_a_hoop_stress_is_of_one_stress_and_one_direction_for_each_node():
    ring = meshes.ring_mesh(0.9, 1.0, 60)
    nodes = len(ring.theta)
    for shape in [(), (3,), (1, 3), (nodes,), (3, nodes), (nodes - 1, 3), (nodes, 2), (nodes, 3, 1)]:
        with pytest.raises(
            ValueError, match=f"stress of shape .* is not possible: .* 3 components for each of {nodes}"
        ):
            meshes.hoop_stress(ring, np.zeros(shape))
    for shape in [(2,), (nodes, 3), (nodes - 1, 2)]:
        with pytest.raises(ValueError, match=f"along of shape .* is not possible: .* 2 components for each of {nodes}"):
            meshes.hoop_stress(ring, np.zeros((nodes, 3)), np.zeros(shape))

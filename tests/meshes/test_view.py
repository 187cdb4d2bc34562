"""Pictures off-screen: not blank, the hoop where it should be, and a sentence where nothing can be drawn."""

import gc
import json
import os
import re
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from meshes import SeriesError, SeriesWriter, disk_block, read
from meshes.draw import display as renderer_module
from meshes.draw.display import probe, renderer_problem
from meshes.draw.lens import enlargement
from meshes.draw.renderer import ABOVE_FLOOR, deformed
from meshes.draw.shots import SeriesSource
from meshes.view.pictures import Camera, Timing, ViewError, animate, picture, render, window
from meshes.view.setting import setting
from rigid import Friction, Hoop, Motion, Phase, Release, Scene, States, load_scene, simulate
from rigid.kernel.compile import Patience

SIZE = (640, 480)
TIMES = np.linspace(0, 1.2, 7)

needs_renderer = pytest.mark.skipif(renderer_problem() is not None, reason=str(renderer_problem()))


@pytest.fixture(autouse=True)
def freed():
    """Plotters and what they draw hold one another in cycles, with megabytes that the collector does not see."""
    yield
    gc.collect()


@pytest.fixture(scope="module")
def series(tmp_path_factory, ring, ovals):
    directory = tmp_path_factory.mktemp("view")
    with SeriesWriter(directory, title="oval") as writer:
        writer.history(**ovals.history(TIMES))
        for frame in ovals.frames(ring, TIMES):
            writer.add(frame)
    return read(directory)


@pytest.fixture(scope="module")
def camera(series):
    """One for all that looks at the series as it is: pictures leave nothing in it."""
    with Camera(setting(series), SIZE) as one:
        yield one


@pytest.fixture(scope="module")
def opened(series):
    """A window that no one sees."""
    from meshes.view.interactive import Window

    one = Window(setting(series), off_screen=True, size=SIZE)
    yield one
    one.close()


def rolling_motion(R=1.0, g=1.0):
    """A hoop that rolls steadily: phi = pi/2 + t, N = 1 + t, F = 0.1, slip 0.2 in the second half."""

    def sample(t, side):
        one = np.ones_like(t)
        return States(
            t=t, phi=np.pi / 2 + t, omega=one, alpha=0 * one, x_C=R * t, y_C=R * one, energy=one,
            slip_velocity=np.where(t > 1, 0.2, 0.0), normal_force=1 + t, friction_force=0.1 * one,
        )  # fmt: skip

    phases = (Phase("roll", 0, 1, 0, 1), Phase("skid", 1, 2, 1, 2))
    scene = Scene(Hoop(k=0.25, R=R, g=g), Friction(0.35, 0.3), Release(np.pi / 2))
    return Motion(scene=scene, phases=phases, turns=(), pulses=(), ended="made up", sample=sample)


def pixel(camera, point, middle):
    """Column and row of the page at which a point of the world lies."""
    left, top, width, height = camera.layout.view_box
    scale = height / camera.height
    return (
        left + width / 2 + (point[..., 0] - middle) * scale,
        top + ABOVE_FLOOR * height - point[..., 1] * scale,
    )


def coloured(page):
    """Where the page has ring colours: neither white nor any of the greys."""
    spread = page.max(axis=2).astype(int) - page.min(axis=2)
    return spread > 30


@needs_renderer
def test_the_ring_is_where_it_should_be(series):
    """Strongly stressed points of the exaggerated ring are painted, the paper inside the hoop is not."""
    chosen = setting(series, field="hoop_stress", factor=40)
    with Camera(chosen, SIZE) as camera:
        page = camera.page(TIMES[3])
        shot = chosen.source.shot(TIMES[3])
        middle = camera._middle(shot)
        points, _ = deformed(shot, 40)
        mid_wall = shot.ring.cells[::6, 8]
        strong = np.abs(shot.ring.point_data["hoop_stress"][mid_wall]) > 0.6 * chosen.colours.high
        columns, rows = pixel(camera, points[mid_wall[strong]], middle)
        hits = [coloured(page)[int(r) - 1 : int(r) + 3, int(c) - 1 : int(c) + 3].any()
                for c, r in zip(columns, rows, strict=True)]  # fmt: skip
        assert len(hits) > 10
        assert all(hits)
        column, row = pixel(camera, shot.centre + np.array([-0.6, 0.2]), middle)
        assert (page[int(row), int(column)] == 255).all()


@needs_renderer
def test_floor_and_disk_are_where_they_should_be(camera):
    page = camera.page(0.0).astype(int)
    shot = camera.setting.source.shot(0.0)
    middle = camera._middle(shot)
    column, row = pixel(camera, shot.disk.points[0] + [0.05, 0, 0], middle)
    assert page[int(row), int(column)].max() < 150
    column, row = pixel(camera, np.array([middle + 0.3, -0.12]), middle)
    assert (np.abs(page[int(row), int(column)] - [0xE9, 0xE6, 0xE1]) <= 1).all()


@needs_renderer
def test_the_time_mark_moves_with_time(camera):
    """The black vertical line through both panels stands at the fraction of the time axis that has passed."""
    for time in TIMES[[1, 4]]:
        page = camera.page(time)
        below = page[camera.layout.view_box[1] + camera.layout.view_box[3] :]
        dark = (below.max(axis=2) < 110).sum(axis=0)
        left, right = camera.layout.time_axis
        expected = left + (right - left) * time / TIMES[-1]
        assert abs(int(dark.argmax()) - expected) <= 2


@needs_renderer
def test_a_picture_of_a_series(series, tmp_path):
    from PIL import Image

    picture(series, tmp_path / "a.png", time=0.4, field="stress xy", factor=10, size=SIZE)
    with Image.open(tmp_path / "a.png") as image:
        assert image.size == SIZE
        assert len(image.getcolors(maxcolors=SIZE[0] * SIZE[1])) > 100
    assert list(tmp_path.iterdir()) == [tmp_path / "a.png"]


@needs_renderer
def test_a_rigid_motion_with_its_arrows():
    motion = rolling_motion()
    with Camera(setting(motion), SIZE) as camera:
        page = camera.page(2.0)
        shot = camera.setting.source.shot(2.0)
        middle = camera._middle(shot)
        # the force arrow of the largest force is 0.7 R long, steeply up from the contact
        column, row = pixel(camera, np.array([2.0 + 0.01, 0.3]), middle)
        assert page[int(row) - 2 : int(row) + 3, int(column) - 3 : int(column) + 4].max(axis=2).min() < 80
        # the slip arrow lies under it and is teal
        column, row = pixel(camera, np.array([2.0 + 0.45, -0.1]), middle)
        patch = page[int(row) - 2 : int(row) + 3, int(column) - 2 : int(column) + 3].astype(int)
        assert (patch[..., 1] - patch[..., 0]).max() > 40
        assert not coloured(camera.page(0.5))[int(row), int(column)]  # rolling: no slip arrow


@needs_renderer
def test_a_picture_does_not_depend_on_the_unit_of_length():
    one, other = (render(rolling_motion(R=R), 1.7, size=SIZE) for R in (1.0, 250.0))
    top = slice(100, 300)  # above: units and title; below: nothing differs but round-off in the raster
    differing = (np.abs(one[top].astype(int) - other[top]).max(axis=2) > 40).mean()
    assert differing < 0.002


@needs_renderer
@pytest.mark.parametrize("suffix", [".gif", ".mp4", ".html"])
def test_animations(series, tmp_path, suffix):
    path = tmp_path / f"film{suffix}"
    done = []
    animate(series, path, timing=Timing(frames=4), size=(480, 360), progress=lambda i, n: done.append((i, n)))
    assert done == [(1, 4), (2, 4), (3, 4), (4, 4)]
    content = path.read_bytes()
    if suffix == ".gif":
        from PIL import Image

        with Image.open(path) as image:
            assert image.n_frames == 4
            assert image.convert("RGB").getpixel((2, 2)) == (255, 255, 255)
    elif suffix == ".mp4":
        assert content[4:8] == b"ftyp"
        imageio = pytest.importorskip("imageio.v3")
        assert imageio.imread(path, index=None).shape == (4, 360, 480, 3)
    else:
        text = content.decode()
        assert text.count("iVBOR") == 4  # how every PNG begins in base64
        assert "http" not in text  # it needs nothing else
    assert list(tmp_path.iterdir()) == [path]


def stamps_of(path):
    return json.loads(re.search(r"stamps = (\[.*?\]), fps", path.read_text(encoding="utf-8"))[1])


@needs_renderer
def test_a_page_says_the_times_of_its_frames_in_their_unit(series, tmp_path):
    """As its pictures do: those of the frames that are shown, which are the nearest ones."""
    animate(series, tmp_path / "a.html", timing=Timing(frames=7, pace="time", stop=1.1), size=(480, 360))
    nearest = [TIMES[np.abs(TIMES - t).argmin()] for t in np.linspace(0, 1.1, 7)]
    assert stamps_of(tmp_path / "a.html") == [f"t = {t:.4f} √(R/g)" for t in nearest]
    motion = rolling_motion(R=0.3, g=9.81)
    animate(motion, tmp_path / "b.html", timing=Timing(frames=2), size=(480, 360))
    assert stamps_of(tmp_path / "b.html") == ["t = 0.0000 s", "t = 2.0000 s"]


@needs_renderer
def test_neighbouring_frames_have_different_stamps(tmp_path):
    """However short the stretch is that is shown of a run."""
    animate(rolling_motion(), tmp_path / "a.html", timing=Timing(frames=9, start=1.3, stop=1.3002), size=(480, 360))
    told = stamps_of(tmp_path / "a.html")
    assert len(set(told)) == 9
    assert [float(stamp.split()[2]) for stamp in told] == pytest.approx(np.linspace(1.3, 1.3002, 9), abs=1e-5)


@pytest.mark.slow
@needs_renderer
def test_a_gif_of_a_pulse_is_below_a_megabyte(series, tmp_path):
    animate(series, tmp_path / "a.gif", timing=Timing(frames=30))
    assert (tmp_path / "a.gif").stat().st_size < 0.5e6  # half of the default number of frames


@needs_renderer
def test_a_series_of_one_frame_without_a_history(tmp_path, ring, ovals):
    with SeriesWriter(tmp_path) as writer:
        for frame in ovals.frames(ring, [0.5]):
            writer.add(frame)
    page = render(read(tmp_path), size=SIZE)
    assert page.shape == (SIZE[1], SIZE[0], 3)
    assert coloured(page).sum() > 500
    with pytest.raises(ViewError, match="the run goes from"):
        animate(read(tmp_path), tmp_path / "a.gif")


@needs_renderer
def test_the_window_steps_stretches_and_changes_colours(series):
    from meshes.view.interactive import Window

    opened = Window(setting(series), off_screen=True, size=SIZE)
    before = opened.renderer.image()
    opened.step(100)
    assert opened.time == pytest.approx(0.6, rel=1e-12)
    opened.exaggerate(2.0)
    assert opened.factor == 2 * opened.setting.factor
    opened.next_field()
    assert opened.colours.field != "von_mises"
    assert (opened.renderer.image() != before).any(axis=2).mean() > 0.02
    opened.renderer.close()


@needs_renderer
def test_the_window_has_what_a_picture_has(series):
    """The lens, where it fits; the patch's axes, where the pressure is known; the key help clear of the title."""
    from meshes.view.interactive import HELP, Window

    opened = Window(setting(series, field="hoop_stress"), off_screen=True, size=SIZE)
    shot = SeriesSource(series).shot(0.3)
    assert bool(opened.setting.patches) == bool(opened.layout.aside)
    lensless = opened.layout.fill(opened._paper, shot, opened.factor)
    if opened.lens is not None and opened.lens.fits(shot):
        middle = (slice(SIZE[1] // 5, SIZE[1] // 2), slice(SIZE[0] // 3, 2 * SIZE[0] // 3))
        assert (opened.page(shot)[middle] != lensless[middle]).any(axis=2).mean() > 0.05
    texts = {text.get_text(): text.get_window_extent() for text in opened.layout.figure.texts}
    help_box, title = texts[HELP], texts[SeriesSource(series).title]
    assert not help_box.overlaps(title)
    opened.close()


@needs_renderer
@pytest.mark.parametrize(("key", "ratio"), [("bracketright", 2.0), ("bracketleft", 0.5), ("plus", 2.0), ("minus", 0.5)])
def test_the_keys_do_what_is_documented(opened, key, ratio):
    from meshes.view.interactive import HELP
    from studies.cli.view import view as command

    before = opened.factor
    for action in opened.plotter.iren._key_press_event_callbacks[key]:
        action()
    assert opened.factor == ratio * before
    for text in (HELP, command.help, window.__doc__):
        assert "[ and ]" in text


@needs_renderer
def test_what_is_drawn_goes_by_its_name(camera):
    assert {"ring", "rim", "disk", "floor"} <= set(camera.renderer.plotter.actors)


def test_exaggeration_keeps_the_height_over_the_floor(series):
    shot = SeriesSource(series).shot(0.0)
    true = (shot.ring.points + shot.displacement)[:, 1].min()
    for factor in (0.0, 1.0, 300.0):
        points, _ = deformed(shot, factor)
        assert points[:, 1].min() == pytest.approx(true, abs=1e-12)  # 300 times round-off of a point near 1
    np.testing.assert_array_equal(deformed(shot, 1.0)[1], 0)


def test_the_display_factor_is_1_2_or_5_times_a_power_of_ten(series):
    factor = setting(series).factor
    assert factor == 50  # 1e-3 R is to be shown as at most 0.06 R
    assert setting(series, factor=3.5).factor == 3.5
    assert setting(rolling_motion()).factor == 1


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"field": "colour"}, "there is no field 'colour'"),
        ({"time": 9.0}, "the run goes from 0 to 1.2"),
        ({"time": np.nan}, "the run goes from"),
        ({"factor": -1.0}, "factor"),
    ],
)
def test_bad_wishes_are_one_sentence(series, tmp_path, arguments, words):
    with pytest.raises(ViewError, match=words) as caught:
        picture(series, tmp_path / "a.png", **arguments)
    assert "\n" not in str(caught.value)


def test_bad_animations_are_one_sentence(series, tmp_path):
    nan = float("nan")
    for name, arguments in (
        ("a.avi", {}), ("a.gif", {"frames": 1}), ("a.gif", {"frames": 2.5}), ("a.gif", {"frames": nan}),
        ("a.gif", {"fps": nan}), ("a.gif", {"start": 1.0, "stop": 0.5}), ("a.gif", {"start": nan}),
    ):  # fmt: skip
        with pytest.raises(ViewError):
            animate(series, tmp_path / name, timing=Timing(**arguments))


@pytest.mark.parametrize(
    ("wishes", "told"),
    [
        ({"start": float("nan")}, "start = nan"),
        ({"stop": float("inf")}, "stop = inf"),
        ({"start": "1"}, "start = '1'"),
        ({"start": 0.5, "stop": 0.5}, "start = 0.5 is not possible: it must lie before stop = 0.5"),
    ],
)
def test_a_stretch_that_no_run_has_is_refused_as_it_is_made(wishes, told):
    with pytest.raises(ViewError, match=told):
        Timing(**wishes)


@pytest.mark.parametrize("size", [(300, 240), (320, 200), (0, 0), (-100, 50), (400.5, 300), 300, "big"])
def test_a_page_without_room_is_one_sentence(series, tmp_path, size):
    with pytest.raises(ViewError, match=r"size = .* is not possible"):
        picture(series, tmp_path / "a.png", size=size)


def test_what_cannot_be_drawn_is_one_sentence(tmp_path):
    with pytest.raises(SeriesError, match="holds no series"):
        picture(tmp_path, tmp_path / "a.png")
    with pytest.raises(SeriesError, match="a NoneType cannot be drawn"):
        picture(None, tmp_path / "a.png")
    with pytest.raises(ViewError, match=r"must end in \.png"):
        picture(tmp_path, tmp_path / "a.jpg")


@pytest.mark.parametrize("size", [(320, 240), (321, 601)])
def test_a_picture_of_a_folder(series, size):
    page = render(series.pvd.parent, 0.6, size=size)
    assert page.shape == (size[1], size[0], 3)
    np.testing.assert_array_equal(page, render(series, 0.6, size=size))


def test_a_damaged_frame_is_one_sentence(tmp_path, ring, ovals):
    with SeriesWriter(tmp_path) as writer:
        for frame in ovals.frames(ring, [0.0, 1.0]):
            writer.add(frame)
    (tmp_path / "fields" / "ring-00001.vtu").write_bytes(b"not a mesh")
    with pytest.raises(SeriesError, match="ring-00001"):
        picture(read(tmp_path), tmp_path / "a.png")


def test_nothing_to_draw_with_is_a_sentence(monkeypatch, series, tmp_path):
    """Where VTK crashes, only the probe dies."""
    monkeypatch.setattr(renderer_module, "_PROBE", "import os; os.abort()")
    probe.cache_clear()
    try:
        with pytest.raises(ViewError, match="apt-get install libegl1"):
            picture(series, tmp_path / "a.png")
        monkeypatch.setattr(renderer_module, "_PROBE", "import no_such_module_here")
        probe.cache_clear()
        with pytest.raises(ViewError, match="pip install pyvista"):
            picture(series, tmp_path / "a.png")
    finally:
        probe.cache_clear()
    assert not list(tmp_path.iterdir())


@needs_renderer
@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="hides EGL from the loader of Linux")
def test_without_egl_the_process_survives(series, tmp_path):
    code = (
        "from meshes import read; from meshes.view import picture, ViewError\n"
        f"try: picture(read({str(series.pvd)!r}), {str(tmp_path / 'a.png')!r})\n"
        "except ViewError as error: print(error)"
    )
    hidden = {name: value for name, value in os.environ.items() if not name.endswith("DISPLAY")}
    hidden["__EGL_VENDOR_LIBRARY_DIRS"] = str(tmp_path)
    options = {"cwd": Path(__file__).parents[2], "capture_output": True, "text": True}
    done = subprocess.run([sys.executable, "-c", code], env=hidden, **options)
    assert done.returncode == 0
    assert "EGL" in done.stdout or (tmp_path / "a.png").exists()  # the latter where OSMesa is installed


def test_no_screen_is_a_sentence(monkeypatch, series):
    if renderer_problem() is not None or not sys.platform.startswith("linux"):
        pytest.skip("says something else here")
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    with pytest.raises(ViewError, match="no screen"):
        window(series)


def test_importing_the_view_loads_no_graphics():
    heavy = {"pyvista", "vtkmodules", "matplotlib", "PIL", "meshio"}
    code = f"import sys, meshes, meshes.view; print({heavy} & set(sys.modules))"
    options = {"cwd": Path(__file__).parents[2], "capture_output": True, "text": True}
    done = subprocess.run([sys.executable, "-c", code], check=True, **options)
    assert done.stdout.strip() == "set()"


@needs_renderer
@pytest.mark.parametrize("name", ["paper-3.1", "paper-point-mass"])
def test_the_papers_scenes_can_be_drawn(name, tmp_path, monkeypatch):
    for module in ("solve", "sampler"):
        monkeypatch.setattr(f"rigid.{module}.patience", Patience(10**9))  # a renderer is heavy without compiled code
    animate(simulate(load_scene(name)), tmp_path / "a.gif", timing=Timing(frames=3), size=(320, 240))
    assert (tmp_path / "a.gif").stat().st_size > 5000  # three pages that are not blank


@needs_renderer
def test_a_file_without_a_folder_is_refused_before_anything_is_drawn(tmp_path):
    for draw, name in ((picture, "a.png"), (animate, "a.gif"), (animate, "a.html")):
        with pytest.raises(ViewError, match="there is no folder"):
            draw(None, tmp_path / "nowhere" / name)  # of nothing at all: it is not looked at


@needs_renderer
@pytest.mark.skipif(not Path("/proc/self").exists(), reason="no folder there that takes no file of anybody's")
def test_a_file_that_cannot_be_written_is_refused_before_anything_is_drawn(tmp_path):
    """Into a folder that takes none, of a name too long, in the place of a folder; nothing is left where it can be."""
    for draw, suffix in ((picture, ".png"), (animate, ".gif"), (animate, ".html")):
        (tmp_path / f"folder{suffix}").mkdir(exist_ok=True)
        for path in (Path("/proc") / f"a{suffix}", tmp_path / ("a" * 300 + suffix), tmp_path / f"folder{suffix}"):
            with pytest.raises(ViewError, match=r"a*\S* cannot be written: .*\.$"):
                draw(None, path)
    assert {path.name for path in tmp_path.iterdir()} == {"folder.png", "folder.gif", "folder.html"}


def test_an_enlarged_view_keeps_the_contact_in_the_middle(series):
    chosen = setting(series, zoom=8)
    assert chosen.factor <= setting(series).factor / 5  # 8, rounded to a tidy factor
    with Camera(chosen, SIZE) as camera:
        page = camera.page(0.6)
        shot = chosen.source.shot(0.6)
        assert camera._middle(shot) == pytest.approx(shot.centre[0] + camera.aside)
        # the wall of 0.02 R above the contact is now many pixels high
        column, row = pixel(camera, np.array([shot.centre[0] - 0.08, 0.015]), camera._middle(shot))
        assert coloured(page)[int(row) - 3 : int(row) + 1, int(column)].all()
    with pytest.raises(ViewError, match="zoom"):
        setting(series, zoom=0.5)


@pytest.mark.parametrize("key", ["time", "zoom", "factor"])
def test_a_number_of_a_picture_that_is_text_is_refused(series, tmp_path, key):
    with pytest.raises(ViewError, match=rf"^{key} = 'a' is not possible"):
        picture(series, tmp_path / "a.png", **{key: "a"})


@needs_renderer
def test_nothing_of_an_enlarged_view_lies_under_the_colour_bar(series, camera):
    """The strip of the bar is that of the page without a hoop, whatever the enlargement lays there."""
    strips = []
    with Camera(setting(series, zoom=5), SIZE) as enlarged:
        for view in (camera, enlarged):
            page, layout = view.page(0.6), view.layout
            _, top, width, height = layout.view_box
            strips.append(page[top : top + int(height * ABOVE_FLOOR) - 4, width - layout.covered : width])
    np.testing.assert_array_equal(*strips)


@needs_renderer
def test_an_enlarged_view_ends_beside_the_colour_bar_with_its_floor(series):
    """The ring is cut off there: nothing of the floor goes on below the bar, of a whole hoop's view it does."""
    seen = []
    for zoom in (1, 5):
        with Camera(setting(series, zoom=zoom), SIZE) as view:
            _, top, width, height = view.layout.view_box
            below = view.page(0.6)[
                top + int(height * ABOVE_FLOOR) - 4 : top + height, width - view.layout.covered : width
            ]
            seen.append(bool((below < 250).any()))
    assert seen == [True, False]


@needs_renderer
def test_the_lens_enlarges_the_wall_above_the_contact(series):
    """A wall of 0.02 R is 6 times as high in it as outside, and of the same colours."""
    with Camera(setting(series, field="hoop_stress"), SIZE) as camera:
        assert camera.lens is not None
        assert camera.lens.times == 6
        time = 0.4  # the contact is at theta = 0.54, where sin 2 theta is large
        shot = camera.setting.source.shot(time)
        assert camera.lens.fits(shot)
        page = camera.page(time)
        column, row = pixel(camera, np.array([shot.centre[0], 1.32]), camera._middle(shot))
        size = camera.lens.size // 2 - 4
        inside = coloured(page)[int(row) - size : int(row) + size, int(column)].sum()
        wall = 0.0196 * camera.scale * 6
        assert inside == pytest.approx(wall, abs=3)  # lines along both edges of the wall are a pixel wide


@needs_renderer
@pytest.mark.parametrize("distance", [0.15, 0.35, 0.6])
def test_the_disk_is_never_over_what_is_printed_below_the_lens(camera, distance):
    """Wherever the disk is: no pixel of the caption is painted by it, and where it is far away there is a lens."""
    shot = camera.setting.source.shot(0.4)
    lens, layout = camera.lens, camera.layout
    column, _ = pixel(camera, np.array([shot.centre[0], 0.0]), camera._middle(shot))
    fits = []
    for phi in np.linspace(0, 2 * np.pi, 73):
        disk = disk_block(shot.centre + distance * np.array([np.sin(phi), np.cos(phi)]), 0.2, phi)
        moved = replace(shot, disk=disk)
        fits.append(lens.fits(moved))
        if fits[-1]:
            view = np.full((*layout.view_box[3:1:-1], 3), 255, dtype=np.uint8)
            layout.fill(view, moved, 1.0, lens.draw(view, moved, column, ABOVE_FLOOR * layout.view_box[3]))
            box = layout._lens.get_window_extent()
            x, row = pixel(camera, disk.points[1:], camera._middle(shot))
            y = SIZE[1] - row
            assert not ((x > box.x0) & (x < box.x1) & (y > box.y0) & (y < box.y1)).any()
    assert any(fits) == (distance == 0.6)
    assert not all(fits)


@needs_renderer
def test_no_lens_over_an_empty_floor(camera):
    """In flight the rim is soon above all that the lens shows; on the floor and just off it is within."""
    shot = camera.setting.source.shot(0.4)
    found = []
    for height in (0.0, 0.05, 0.2):
        ring = replace(shot.ring, points=shot.ring.points + np.array([0.0, height, 0.0]))
        found.append(camera.lens.fits(replace(shot, ring=ring, centre=shot.centre + np.array([0.0, height]))))
    assert found == [True, True, False]


def test_no_lens_where_the_wall_is_thick_or_the_disk_in_the_way(series, ovals):
    from meshes import ring_mesh

    thin = SeriesSource(series).shot(0.0)
    assert enlargement(thin) == 6
    (thick,) = ovals.frames(ring_mesh(0.8, 1.0, 60), [0.0])
    assert enlargement(replace(thin, ring=thick.blocks["ring"])) == 1  # and not 0, which scales are divided by

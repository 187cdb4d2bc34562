"""Pages in time as one file: gif, mp4, or an html page with a slider."""

from __future__ import annotations

import base64
import io
import itertools
import json
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from rigid.output.whole import try_out, write_whole

from ..draw import style
from ..draw.display import ViewError

Image = NDArray[np.uint8]
Writer = Callable[[Path, Iterator[Image], int, Sequence[str]], None]


@dataclass(frozen=True)
class Format:
    """A kind of file: how many pictures of which size it gets unless told, and what writes it."""

    frames: int
    size: tuple[int, int]
    write: Writer


def write_png(path: Path, page: Image) -> None:
    """One page as a PNG file."""
    from PIL import Image as Pillow

    _whole(path, lambda part: Pillow.fromarray(page).save(part, format="png", optimize=True))


def write_gif(path: Path, pages: Iterator[Image], fps: int, stamps: Sequence[str]) -> None:
    """Pages as an endless gif with one palette, that of the first page, which has nearly every colour."""
    from matplotlib.colors import to_rgb
    from PIL import Image as Pillow

    first = next(pages)
    late = np.array([to_rgb(colour) for colour in (style.FORCE, style.SLIP, style.PAPER)]) * 255
    swatches = np.repeat(late.round().astype(np.uint8), first.shape[1] // 3, axis=0)
    model = first.copy()
    model[:16, : len(swatches)] = swatches
    palette = Pillow.fromarray(model).quantize(colors=128, method=Pillow.Quantize.MEDIANCUT)
    table = np.array(palette.getpalette()).reshape(-1, 3)
    white = int(table.sum(axis=1).argmax())
    table[white] = 255
    palette.putpalette(table.ravel().tolist())

    def flatten(page: Image) -> Pillow.Image:
        # without dithering, which would flicker and does not compress; Pillow's search for the nearest entry
        # is coarse and takes near-white for white, which shows against the page around the gif
        image = Pillow.fromarray(page).quantize(palette=palette, dither=Pillow.Dither.NONE)
        image.paste(white, mask=Pillow.fromarray((page == 255).all(axis=2)))
        return image

    flat = [flatten(page) for page in itertools.chain([first], pages)]
    duration = round(1000 / fps)
    last = [duration] * (len(flat) - 1) + [1000]

    def save(part: Path) -> None:
        more = {"append_images": flat[1:], "duration": last}
        flat[0].save(part, format="gif", save_all=True, loop=0, optimize=True, **more)

    _whole(path, save)


def write_mp4(path: Path, pages: Iterator[Image], fps: int, stamps: Sequence[str]) -> None:
    """Pages as an H.264 film."""
    try:
        from imageio_ffmpeg import write_frames  # type: ignore[import-untyped]
    except ModuleNotFoundError:
        raise ViewError("a film needs imageio-ffmpeg: pip install imageio-ffmpeg.") from None

    def save(part: Path) -> None:
        first = next(pages)
        size = first.shape[1] // 2 * 2, first.shape[0] // 2 * 2  # H.264 wants even numbers
        stream = write_frames(
            str(part), size, fps=fps, codec="libx264", quality=None, macro_block_size=1,
            output_params=["-crf", "20", "-f", "mp4", "-movflags", "+faststart"],
        )  # fmt: skip
        stream.send(None)
        try:
            for page in itertools.chain([first], pages):
                stream.send(np.ascontiguousarray(page[: size[1], : size[0]]))
        finally:
            stream.close()

    _whole(path, save)


def write_html(path: Path, pages: Iterator[Image], fps: int, stamps: Sequence[str]) -> None:
    """Pages as one html file with a slider and the stamp of each, that needs nothing else."""
    from PIL import Image as Pillow

    codes = []
    for page in pages:
        code = io.BytesIO()
        flat = Pillow.fromarray(page).quantize(colors=128, dither=Pillow.Dither.NONE)
        flat.save(code, "png", optimize=True)
        codes.append(f'"{base64.b64encode(code.getvalue()).decode()}"')
    told = json.dumps(list(stamps)).replace("<", "\\u003c")  # a unit is a text of somebody's
    content = _HTML.replace("@STAMPS@", told).replace("@FPS@", str(fps))
    content = content.replace("@IMAGES@", ",\n".join(codes))
    _whole(path, lambda part: part.write_text(content, encoding="utf-8"))


FORMATS = {
    ".gif": Format(60, (800, 600), write_gif),
    ".mp4": Format(150, (1280, 900), write_mp4),
    ".html": Format(60, (960, 720), write_html),
}


def require_folder(path: Path) -> None:
    """Refuse a file for which there is no folder, or one that takes no such file, before anything is drawn."""
    if not path.parent.is_dir():
        raise ViewError(f"{path} cannot be written: there is no folder {path.parent}.")
    with _told(path):
        try_out(path)


def _whole(path: Path, save: Callable[[Path], object]) -> None:
    """Save a file whole or not at all, with trouble in a sentence."""
    with _told(path):
        write_whole(path, save)


@contextmanager
def _told(path: Path) -> Iterator[None]:
    """Trouble with a file in a sentence."""
    try:
        yield
    except OSError as error:
        said = error.strerror or " ".join(str(error).split()[:60])  # ffmpeg's own words may fill a screen
        raise ViewError(f"{path} cannot be written: {said}.") from None


_HTML = """<!doctype html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width">
<title>hoop-pulse</title>
<style>
body { margin: 0; font: 15px system-ui, sans-serif; color: #2b2f36; background: #fff; }
main { max-width: 960px; margin: 1em auto; padding: 0 1em; }
img { width: 100%; display: block; }
nav { display: flex; gap: 1em; align-items: center; }
input { flex: 1; accent-color: #1f5a94; }
button { font: inherit; width: 5em; padding: .3em; border: 1px solid #c9ced5; border-radius: .4em; }
output { min-width: 8em; font-variant-numeric: tabular-nums; }
</style></head><body><main>
<img id="page" alt="the hoop at one instant, with normal and friction force over time below">
<nav><button id="play">play</button><input id="time" type="range" min="0" value="0" aria-label="time">
<output id="stamp"></output></nav>
<p>space plays and stops, the arrow keys step</p>
</main><script>
const images = [
@IMAGES@
], stamps = @STAMPS@, fps = @FPS@;
const page = document.getElementById("page"), slider = document.getElementById("time");
const button = document.getElementById("play"), stamp = document.getElementById("stamp");
let timer = null;
slider.max = images.length - 1;
function show(i) {
  slider.value = i;
  page.src = "data:image/png;base64," + images[i];
  stamp.value = stamps[i];
}
function toggle() {
  if (timer) { clearInterval(timer); timer = null; button.textContent = "play"; return; }
  button.textContent = "stop";
  timer = setInterval(() => show((+slider.value + 1) % images.length), 1000 / fps);
}
slider.oninput = () => show(+slider.value);
button.onclick = toggle;
document.onkeydown = event => {
  if (event.key === " ") { event.preventDefault(); toggle(); }
  if (event.target === slider) return;
  if (event.key === "ArrowRight") show((+slider.value + 1) % images.length);
  if (event.key === "ArrowLeft") show((+slider.value + images.length - 1) % images.length);
};
show(0);
</script></body></html>
"""

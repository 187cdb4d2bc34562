"""The documentation as one static site: ``python -m studies.site [FOLDER]``.

A page for every package, made by pdoc from the docstrings of what its face has, with its theory (README.md, and those
of its rooms).
The first page is the README of the project. Formulas become MathML, which a browser shows without a network. pdoc and
latex2mathml are what the extra ``docs`` installs.
"""

from __future__ import annotations

import re
import shutil
import types
import warnings
from importlib import import_module
from pathlib import Path
from tempfile import TemporaryDirectory

import click

ROOT = Path(__file__).parent.parent
PACKAGES = ("rigid", "meshes", "flexible", "studies")
PAGE = re.compile(r"\]\(([\w./]*)(README|CHANGELOG)\.md(#[^)]*)?\)")
FILE = re.compile(r"\]\(([^):#]+)\)")
PICTURES = re.compile(r"(\]\(|src=\")(?:\.\./)*\.images/")
FORMULA_OR_CODE = re.compile(
    r"^(?P<indent> *)```math\n(?P<fenced>.+?)\n *```|(?P<code>^ *```.*?^ *```|`[^`]*`)"
    r"|\$\$(?P<display>.+?)\$\$|\$(?P<inline>[^$\s](?:[^$]*[^$\s])?)\$",
    re.DOTALL | re.MULTILINE,
)
ROOM = re.compile(r"^``(\w+)``  +(.*(?:\n  +\S.*)*)", re.MULTILINE)
STYLE = ".pdoc img { max-width: 100%; } .pdoc math[display=block] { margin: 1em 0; overflow-x: auto; }"


def text_of(path: Path, formulas: dict[str, str]) -> str:
    """A README whose links stay within the site; each formula is a word that ``formulas`` has as MathML."""

    def word(found: re.Match[str]) -> str:
        from latex2mathml.converter import convert

        if found["code"]:
            return found["code"]
        name = f"formula{len(formulas)}x"
        block = found["fenced"] or found["display"]
        formulas[name] = convert(block or found["inline"], display="block" if block else "inline")
        return f"\n\n{name}\n\n" if found["display"] else (found["indent"] or "") + name

    def link(found: re.Match[str]) -> str:
        """To the page of the package that has this text, at the title of it where it is not the package's own."""
        target = (path.parent / found[1] / f"{found[2]}.md").resolve()
        page, *rooms = target.relative_to(ROOT).parts[:-1] or ("index",)
        own = not rooms and found[2] == "README"
        return f"]({page}.html{found[3] or ('' if own else f'#{title_of(target)}')})"

    text = PAGE.sub(link, path.read_text(encoding="utf-8"))
    return FORMULA_OR_CODE.sub(word, PICTURES.sub(r"\1images/", text))


def title_of(path: Path) -> str:
    """The anchor of a README's title."""
    title = path.read_text(encoding="utf-8").partition("\n")[0]
    return re.sub(r"\W+", "-", title.lstrip("# ").lower())


def theories(package: str) -> list[Path]:
    """The READMEs of a package and of its rooms, its own first, and its log of changes."""
    pages = sorted((ROOT / package).rglob("README.md"), key=lambda path: len(path.parts))
    return [*pages, *(ROOT / package).glob("CHANGELOG.md")]


def face_of(docstring: str) -> str:
    """A package's docstring in Markdown: its rooms, aligned by spaces there, as a list."""
    listed = ROOM.sub(lambda room: f"* `{room[1]}`: {' '.join(room[2].split())}", docstring)
    return listed.replace("::\n", ":\n")


def build(out: Path) -> Path:
    """Write the site.

    Parameters
    ----------
    out : path
        A folder, made if it is not there; pages of an earlier site in it are replaced.

    Returns
    -------
    path
        Of its first page.
    """
    import pdoc
    import pdoc.doc
    import pdoc.render

    formulas: dict[str, str] = {}
    for package in PACKAGES:
        module = import_module(package)
        vars(module).update({name: getattr(module, name) for name in module.__all__})  # faces load on demand
        if "<!-- theory -->" not in (module.__doc__ or ""):
            texts = [face_of(module.__doc__ or ""), *(text_of(path, formulas) for path in theories(package))]
            module.__doc__ = "\n\n<!-- theory -->\n\n".join(texts)
    title, _, text = text_of(ROOT / "README.md", formulas).partition("\n")
    front = types.ModuleType(title.lstrip("# "), text)
    front.__all__ = []  # type: ignore[attr-defined]
    first = out / "index.html"
    with TemporaryDirectory() as templates, warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of pdoc, on annotations that it cannot look up
        (Path(templates) / "custom.css").write_text(STYLE, encoding="utf-8")
        pdoc.render.configure(docformat="numpy", search=True, show_source=True, template_directory=Path(templates))
        pdoc.pdoc(*PACKAGES, output_directory=out)
        pages = {name: pdoc.doc.Module(import_module(name)) for name in PACKAGES}
        first.write_text(pdoc.render.html_module(pdoc.doc.Module(front), pages), encoding="utf-8")
    index = out / "search.js"
    index.write_text(re.sub(r"formula\d+x", "", index.read_text(encoding="utf-8")), encoding="utf-8")
    for page in out.glob("*.html"):  # only now, for Markdown would take a formula that begins a line for a paragraph
        html = page.read_text(encoding="utf-8")
        page.write_text(re.sub(r"formula\d+x", lambda name: formulas[name[0]], html), encoding="utf-8")
    for file in {ROOT / name for name in FILE.findall(front.__doc__ or "")}:
        if file.is_file():  # notebooks
            target = out / file.relative_to(ROOT)
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(file, target)
    shutil.copytree(ROOT / ".images", out / "images", dirs_exist_ok=True)
    return first


@click.command(context_settings={"help_option_names": ["-h", "--help"]})
@click.argument("folder", type=click.Path(file_okay=False, path_type=Path), default=ROOT / "build" / "site")
def main(folder: Path) -> None:
    """The documentation as one static site in FOLDER, by default build/site of the checkout."""
    if not (ROOT / "README.md").is_file():
        raise click.UsageError("The site is made of a checkout's pages, and this is an installed package.")
    try:
        click.echo(build(folder))
    except ModuleNotFoundError as error:
        raise click.UsageError(f"The site needs {error.name}: install hoop-pulse with the extra [docs].") from None


if __name__ == "__main__":
    main()

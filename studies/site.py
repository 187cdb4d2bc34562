"""The documentation as one static site: ``python -m studies.site [FOLDER]``.

A page for every package, made by pdoc from the docstrings of what its face has, with its theory (README.md).
The first page is the README of the project. pdoc is what the extra ``docs`` installs.
"""

from __future__ import annotations

import re
import shutil
import sys
import types
import warnings
from importlib import import_module
from pathlib import Path

ROOT = Path(__file__).parent.parent
PACKAGES = ("rigid", "meshes", "flexible", "studies")
TEXT_OF_ITS_OWN = re.compile(r"\]\((?:\.\./)?(rigid|meshes|flexible|studies)/README\.md(#[^)]*)?\)")
FILE = re.compile(r"\]\(([^):#]+)\)")
PICTURES = re.compile(r"(\]\(|src=\")(?:\.\./)?\.images/")


def text_of(path: Path) -> str:
    """A README whose links stay within the site."""
    text = path.read_text(encoding="utf-8")
    text = TEXT_OF_ITS_OWN.sub(lambda found: f"]({found[1]}.html{found[2] or ''})", text)
    return PICTURES.sub(r"\1images/", text)


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

    for package in PACKAGES:
        module, theory = import_module(package), ROOT / package / "README.md"
        vars(module).update({name: getattr(module, name) for name in module.__all__})  # faces load on demand
        if theory.exists() and "<!-- theory -->" not in (module.__doc__ or ""):
            module.__doc__ = f"{module.__doc__}\n\n<!-- theory -->\n\n{text_of(theory)}"
    pdoc.render.configure(docformat="numpy", math=True, search=True, show_source=True)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of pdoc, on annotations that it cannot look up
        pdoc.pdoc(*PACKAGES, output_directory=out)
    front = types.ModuleType("hoop-pulse", text_of(ROOT / "README.md"))
    front.__all__ = []  # type: ignore[attr-defined]
    pages = {name: pdoc.doc.Module(import_module(name)) for name in PACKAGES}
    first = out / "index.html"
    first.write_text(pdoc.render.html_module(pdoc.doc.Module(front), pages), encoding="utf-8")
    for file in {ROOT / name for name in FILE.findall(front.__doc__ or "")}:
        if file.is_file():  # notebooks, the changelog
            target = out / file.relative_to(ROOT)
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(file, target)
    shutil.copytree(ROOT / ".images", out / "images", dirs_exist_ok=True)
    return first


def main(arguments: list[str]) -> None:
    """Build it where the first argument says, by default in ``build/site``."""
    print(build(Path(arguments[0]) if arguments else ROOT / "build" / "site"))


if __name__ == "__main__":
    main(sys.argv[1:])

"""A friction law in a file of its own, in a copy of the packages: what stands in ``tanh_law.py``, and a few lines."""

import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import matplotlib.pyplot as plt
import numpy as np

import flexible

PACKAGES = Path(flexible.__file__).parents[1]
LINES = {
    "rigid/elastic.py": [('"regularised")', '"regularised", "tanh")')],
    "flexible/contact/laws/listing.py": [
        ("from . import brush, patch, regularised", "from . import brush, patch, regularised, tanh_law"),
        ("(Patch, Brush, Regularised)", "(Patch, Brush, Regularised, tanh_law.Tanh)"),
        ("    return regularised.tractions", "    if law.law == tanh_law.CODE:\n        return tanh_law.tractions"
         "(forces, points, foundation, carried, mode, load, slip, law)\n    return regularised.tractions"),
    ],
}  # fmt: skip
RUN = """
import numpy, flexible, rigid
for law in ("patch", "regularised", "tanh"):
    scene = rigid.load_scene("paper-3.3-massless").replace(
        contact={"law": law, "stiffness": 1e8, "slip_velocity_scale": 0.01},
        solve={"rtol": 1e-3}, run={"until": "pulse"})
    motion = flexible.simulate(scene)
    pulse = motion.pulses[0]
    print(f"{law:12} J_F/J_N = {pulse.impulse_ratio:.4f}; to compare, rigid:",
          f"{rigid.simulate(flexible.rigid_limit(scene)).pulses[0].impulse_ratio:.4f}")
    states = motion.at(numpy.linspace(pulse.t_start, pulse.t_end, 2000))
    numpy.savetxt(law, numpy.column_stack([states.phi, states.friction_force]))
"""


def main(out: Path = Path()) -> Path:
    with TemporaryDirectory() as folder:
        copy = Path(folder)
        for package in ("rigid", "meshes", "flexible"):
            for source in (path for path in (PACKAGES / package).rglob("*") if path.suffix in (".py", ".toml")):
                target = copy / source.relative_to(PACKAGES)
                target.parent.mkdir(parents=True, exist_ok=True)
                text = source.read_text(encoding="utf-8")
                for old, new in LINES.get(source.relative_to(PACKAGES).as_posix(), []):
                    assert old in text
                    text = text.replace(old, new)
                target.write_text(text, encoding="utf-8")
        law = Path(__file__).with_name("tanh_law.py").read_text(encoding="utf-8")
        (copy / "flexible/contact/laws/tanh_law.py").write_text(law, encoding="utf-8")
        subprocess.run([sys.executable, "-c", f"import sys; sys.path[0] = '.'\n{RUN}"], cwd=copy, check=True)
        figure, axes = plt.subplots(layout="constrained")
        for name in ("patch", "regularised", "tanh"):
            axes.plot(*np.loadtxt(copy / name).T, label=name)
    axes.set(xlabel=r"angle of the disk $\phi$", ylabel="friction force $F/(mg)$")
    axes.legend()
    figure.savefig(out / "own-friction-law.png", dpi=150)
    plt.close(figure)
    return out / "own-friction-law.png"


if __name__ == "__main__":
    main()

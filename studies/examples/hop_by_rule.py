"""Which hoops hop, by two rules and no roll: N falls as a slip begins, and a pulse leaves its ring ringing."""

from math import nan
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import rigid
from studies.hop.rolling.drop import drop
from studies.hop.rolling.scaling import foreseen

DAMPING = 0.0, 0.001, 0.01, 0.02, 0.05  # ratio, of the vibration that the pulse leaves


def main(out: Path = Path(), count: int = 7) -> Path:
    k = np.geomspace(0.05, 0.5, 12)[:count]  # as the map has them
    massless, paper = rigid.load_scene("paper-3.3-massless"), rigid.load_scene("paper-3.3-heavier")  # m_h/m = 0.1
    print("N in front of the first slip over N behind it, mu_s = 0.35")
    for each in (0.1, 0.2, 0.25, 0.3, 0.35):
        print(f"m_h/m = 0, k = {each}, mu = 0.3: {drop(massless.replace(hoop={'k': each})) or nan:.2f}")
    for mu in (0.1, 0.15, 0.3):
        print(f"m_h/m = 0.1, k = 0.1, mu = {mu}: {drop(paper.replace(friction={'mu': mu})) or nan:.2f}")
    print("k, m_h/m: E I/(m g R^2) below which it hops with damping", *DAMPING)
    for one, mass in (*((each, 0.1) for each in k), *((0.1, mass) for mass in (0.03, 0.05, 0.1, 0.2, 0.3, 0.5))):
        scene = paper.replace(hoop={"k": one, "mass_ratio": mass})
        print(f"{one:.3g}, {mass}:", *(f"{foreseen(scene, ratio) or nan:.3g}" for ratio in DAMPING))
    figure, axes = plt.subplots(layout="constrained")
    for ratio in DAMPING:
        axes.plot(k, [foreseen(paper.replace(hoop={"k": each}), ratio) or nan for each in k], label=f"{ratio:g}")
    axes.set(xlabel="radius of the disk $k$", ylabel="hops below $EI/(mgR^2)$, foreseen", title="$m_h/m = 0.1$")
    axes.legend(title="damping ratio in the wall")
    figure.savefig(out / "hop-by-rule.png", dpi=150)
    plt.close(figure)
    return out / "hop-by-rule.png"


if __name__ == "__main__":
    main()

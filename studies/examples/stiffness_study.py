"""Five stiffnesses and their limit, from Python: how fast does the elastic hoop become the rigid one?"""

from pathlib import Path

import matplotlib.pyplot as plt

import rigid
from studies import Ladder, stiffness_study


def main(out: Path = Path(), count: int = 5) -> Path:
    scene = rigid.load_scene("paper-3.2-k0.25")
    ladder = Ladder(along="both", low=1e7, high=1e11, count=count)
    study = stiffness_study(scene, ladder)
    target, found = study.rigid.pulses[0]["impulse_ratio"], study.limits["impulse_ratio"]
    print(f"J_F/J_N tends to {found.value:.5f} +- {found.uncertainty:.1e}; the rigid hoop has {target:.5f}")
    figure, axes = plt.subplots(layout="constrained")
    axes.loglog(
        [rung.contact_stiffness for rung in study.rungs],
        [abs(rung.measure("impulse_ratio") - target) for rung in study.rungs],
        "o-",
    )
    axes.set(xlabel=r"foundation $\varepsilon_n R^2/(mg)$", ylabel="distance of $J_F/J_N$ from the rigid hoop's")
    figure.savefig(out / "stiffness-study.png", dpi=150)
    plt.close(figure)
    return out / "stiffness-study.png"


if __name__ == "__main__":
    main()

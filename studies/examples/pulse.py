"""The inside of a pulse: the friction force of the elastic hoop, and of the rigid one that it nearly is."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import flexible
import rigid


def main(out: Path = Path()) -> Path:
    scene = rigid.load_scene("paper-3.3-massless").replace(
        contact={"stiffness": 1e8, "damping": 1.0}, solve={"rtol": 1e-3}, run={"until": "pulse"}
    )
    figure, axes = plt.subplots(layout="constrained")
    for solver, style in ((flexible, "C1"), (rigid, "k--")):
        name, motion = solver.__name__, solver.simulate(scene)
        pulse = motion.pulses[0]
        print(f"{name:9} J_F/J_N = {pulse.impulse_ratio:.4f}, friction loss {pulse.friction_loss:.4f} m g R")
        states = motion.at(np.linspace(pulse.t_start, pulse.t_end, 2000))
        axes.plot(states.phi, states.friction_force, style, label=f"{name}: $J_F/J_N$ = {pulse.impulse_ratio:.4f}")
    axes.set(xlabel=r"angle of the disk $\phi$", ylabel="friction force $F/(mg)$")
    axes.legend()
    figure.savefig(out / "pulse.png", dpi=150)
    plt.close(figure)
    return out / "pulse.png"


if __name__ == "__main__":
    main()

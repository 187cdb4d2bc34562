"""The paper's hoop (section 3.1) through its first cycle: the slip velocity, and every phase by its colour."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import rigid

COLOURS = {"roll": "0.9", "spin": "#56B4E9", "skid": "#E69F00"}


def main(out: Path = Path()) -> Path:
    motion = rigid.simulate("paper-3.1")
    first, pulse = motion.turns[0], motion.pulses[0]
    print(f"the disk turns back at phi = {first.phi:.5f}; J_F/J_N = {pulse.impulse_ratio:.5f} in the first pulse")
    t = np.union1d(np.linspace(0, first.t, 500), np.linspace(pulse.t_start, pulse.t_end, 500))
    figure, axes = plt.subplots(layout="constrained")
    for phase in motion.phases:
        if phase.t_start < first.t:
            axes.axvspan(phase.t_start, min(phase.t_end, first.t), color=COLOURS[phase.kind], label=phase.kind)
    axes.plot(t, motion.at(t).slip_velocity, color="black")
    axes.set(xlabel=r"$t/\sqrt{R/g}$", ylabel=r"slip velocity $v/\sqrt{gR}$")
    handles = dict(zip(*reversed(axes.get_legend_handles_labels()), strict=True))
    axes.legend(handles.values(), handles.keys(), loc="upper left")
    figure.savefig(out / "rigid-motion.png", dpi=150)
    plt.close(figure)
    return out / "rigid-motion.png"


if __name__ == "__main__":
    main()

"""Ten thousand hoops at once: J_F/(mu J_N) of the first pulse over the disk's radius and the friction."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from rigid import simulate_batch


def main(out: Path = Path(), side: int = 100) -> Path:
    k, mu = np.linspace(0.02, 0.6, side), np.linspace(0.05, 1.0, side)
    across, up = (axis.ravel() for axis in np.meshgrid(k, mu))
    hoops = {"k": across, "mu": up, "mu_s": 7 / 6 * up, "phi0": np.deg2rad(10)}
    batch = simulate_batch(hoops, until="pulse", pulses=1)
    share = batch.impulse_ratio[:, 0] / up
    print(f"{len(batch)} hoops; sliding throughout would be 1: the largest is {np.nanmax(np.abs(share)):.3f}")
    figure, axes = plt.subplots(layout="constrained")
    filled = axes.pcolormesh(k, mu, share.reshape(side, side), cmap="RdBu_r", vmin=-1, vmax=1)
    axes.set(xlabel="radius of the disk $k$", ylabel=r"friction $\mu$ ($\mu_s = 7\mu/6$)")
    figure.colorbar(filled, label=r"$J_F/(\mu J_N)$ of the first pulse")
    figure.savefig(out / "batch-map.png", dpi=150)
    plt.close(figure)
    return out / "batch-map.png"


if __name__ == "__main__":
    main()

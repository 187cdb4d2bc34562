"""The ring's fields as a PVD series: written once, opened with pyvista, its stress drawn where N is largest."""

from pathlib import Path

import numpy as np
import pyvista

import flexible
import meshes
import rigid


def main(out: Path = Path(), frames: int = 12) -> Path:
    scene = rigid.load_scene("paper-3.3-light").replace(solve={"rtol": 1e-2}, run={"until": "pulse"})
    motion = flexible.simulate(scene, history=True)
    flexible.write_fields(motion, out / "fields", frames=frames)
    series = meshes.read(out / "fields")
    reader = pyvista.get_reader(str(out / "fields" / "fields.pvd"))  # what ParaView opens too
    history = series.history
    forces = np.interp(series.times, history["t"], history["normal_force"])
    reader.set_active_time_point(int(np.argmax(forces)))
    ring = reader.read()[0]
    print(f"{ring.n_cells} cells, {ring.point_data.keys()}")
    largest = float(np.abs(ring["hoop_stress"]).max())
    plotter = pyvista.Plotter(off_screen=True, window_size=[900, 700])
    plotter.add_mesh(
        ring,
        scalars="hoop_stress",
        cmap="RdBu_r",
        clim=(-largest, largest),
        scalar_bar_args={"title": "hoop stress / (m g/R²)\n", "n_labels": 3, "fmt": "%.3g"},
    )
    plotter.camera_position = "xy"
    plotter.camera.parallel_projection = True
    plotter.camera.focal_point = (ring.center[0], 0.05, 0.0)  # the contact
    plotter.camera.position = (ring.center[0], 0.05, 1.0)
    plotter.camera.parallel_scale = 0.15
    plotter.screenshot(out / "fields-in-pyvista.png")
    plotter.close()
    return out / "fields-in-pyvista.png"


if __name__ == "__main__":
    main()

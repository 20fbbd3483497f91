"""Shows the results beside this file with PyVista: python3 plot_frame.py [TIME] [PICTURE.png]

Without a TIME the last frame; with a PICTURE that is written, and no window opens. What it needs: pip install pyvista
"""

import pathlib
import sys

import pyvista as pv

folder = pathlib.Path(__file__).resolve().parent
words = sys.argv[1:]
picture = next((word for word in words if word.endswith(".png")), None)
times = [float(word) for word in words if word != picture]

reader = pv.get_reader(str(folder / "results.pvd"))
time = min(reader.time_values, key=lambda t: abs(t - times[0])) if times else reader.time_values[-1]
reader.set_active_time_value(time)
# Each part by the first word of its file: solid, grains, chains, walls.
files = [folder / dataset.path for dataset in reader.active_datasets]
parts = {file.stem.split("_")[0]: pv.read(file) for file in files}

view = pv.Plotter(off_screen=picture is not None, window_size=(1280, 720))
view.add_text(f"t = {time:.4g} s", font_size=10)
if "solid" in parts:
    solid = parts["solid"]
    solid["vertical stress [kPa]"] = 1e-3 * solid["stress"].reshape(-1, 3, 3)[:, 2, 2]
    skin = solid.warp_by_vector("displacement").extract_surface(algorithm="dataset_surface")
    view.add_mesh(skin, scalars="vertical stress [kPa]", cmap="viridis")
if "grains" in parts and parts["grains"].n_points:
    grains = parts["grains"]
    grains["diameter"] = 2.0 * grains["radius"]
    ball = pv.Sphere(radius=0.5, theta_resolution=16, phi_resolution=12)
    stones = grains.glyph(scale="diameter", orient=False, geom=ball)
    view.add_mesh(stones, color="tan", smooth_shading=True)
if "walls" in parts and parts["walls"].n_cells:
    # Kind 0 are planes, which would hide the bed; 1 other walls, 2 sleepers and plates, 3 rails.
    walls = parts["walls"]
    shown = walls.extract_cells(walls.cell_data["kind"] > 0)
    if shown.n_cells:
        view.add_mesh(shown, color="gray")
view.add_axes()
view.camera_position = "xz"
view.camera.azimuth = 25
view.camera.elevation = 20
view.camera.zoom(1.4)
view.reset_camera_clipping_range()
view.show(screenshot=picture)

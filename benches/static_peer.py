"""Times a static run, from mesh files to results, against CalculiX on one core, in turns.

usage: python3 benches/static_peer.py [elements per side = 16] [runs = 3]
Needs `cargo build --release` and `ccx` (CalculiX 2.20, Debian package calculix-ccx). Both read a text mesh and solve
one load case of 20-node hexahedra with 3x3x3 integration.
"""
import os, resource, subprocess, sys, tempfile

side, runs = (int(a) for a in (sys.argv[1:] + ["16", "3"][len(sys.argv) - 1 :]))
binary = os.environ.get("TRACKBED", os.path.join(os.path.dirname(__file__), "../target/release/trackbed"))
COMMON = """
[[solid.material]]
id = 1
young = "100 MPa"
poisson = 0.3
density = 2000

[[solid.load]]
kind = "traction"
side = "z+"
traction = [0, 0, -1000.0]

[output]
tecplot = false
"""
BLOCK = "[solid]\nintegration = 'full'\ngravity = false\n[solid.block]\n" + "".join(
    f"{axis} = {{ lines = [0.0, 1.0], counts = [{side}] }}\n" for axis in "xyz"
) + "[[solid.support]]\nside = 'z-'\ndirections = ['x', 'y', 'z']\n"
LISTS = """[solid]
integration = "full"
gravity = false
nodes = "lists/NODECOORD.DAT"
elements = "lists/ELEMENTNUM.DAT"
constraints = "lists/DOF.DAT"
"""


def cpu(command, folder):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, cwd=folder, check=True, stdout=subprocess.DEVNULL, env={**os.environ, "OMP_NUM_THREADS": "1"})
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


with tempfile.TemporaryDirectory() as folder:
    path = lambda name: os.path.join(folder, name)
    open(path("block.toml"), "w").write(BLOCK + COMMON)
    open(path("run.toml"), "w").write(LISTS + COMMON)
    program = os.path.abspath(binary)
    for target in ("lists", "block.inp"):
        subprocess.run([program, "mesh", "convert", "block.toml", target], cwd=folder, check=True, stdout=subprocess.DEVNULL)
    text = open(path("block.inp")).read().replace("TYPE=C3D20R", "TYPE=C3D20")
    text = text.replace("*MATERIAL, NAME=MATERIAL_1\n", "*MATERIAL, NAME=MATERIAL_1\n*ELASTIC\n1e8, 0.3\n", 1)
    top = "".join(f"{e},\n" for e in range(side**3 - side**2 + 1, side**3 + 1))
    text += f"*ELSET, ELSET=TOP\n{top}*STEP\n*STATIC, SOLVER=SPOOLES\n*DLOAD\nTOP, P2, 1000.\n*NODE FILE\nU\n*EL FILE\nS\n*END STEP\n"
    open(path("block.inp"), "w").write(text)
    ours = [program, "run", "run.toml", "--threads", "1", "--quiet", "--out", "out"]
    pairs = [(cpu(ours, folder), cpu(["ccx", "block"], folder)) for _ in range(runs)]
    for a, b in pairs:
        print(f"trackbed {a:.2f} CPU s, CalculiX {b:.2f} CPU s, ratio {a / b:.3f}")
    ratios = sorted(a / b for a, b in pairs)
    print(f"median ratio {ratios[len(ratios) // 2]:.3f}")

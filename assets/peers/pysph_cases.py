"""Taylor and Green's vortices by PySPH, for `sliceflow study speed-error --peers PYTHON`.

usage: pysph_cases.py taylor_green_2d REPEATS RESOLUTION...      needs: pip install --pre pysph scipy matplotlib h5py

Prints a line `POINT {...}` for each run: wall seconds of the steps, and the mean over all outputs after the first of PySPH's
own L1 error of speed, an output every 100 steps. Re 100 to t = 2 s, particles displaced by up to a fifth of their spacing, one
core, double precision. Compiling is not counted.
"""
import json
import os
import sys
import tempfile
import time

METHODS = {"EDAC": "edac", "transport velocity": "tvf"}


def run(application, scheme, n, folder):
    app = application()
    app.run(
        ["--scheme", scheme, "--nx", str(n), "--re", "100", "--tf", "2.0", "--perturb", "0.2"]
        + ["--pfreq", "100", "-q", "-d", folder]
    )
    app.post_process(app.info_filename)
    import numpy

    results = numpy.load(os.path.join(folder, "results.npz"))
    return dict(
        particles=n * n,
        steps=int(app.solver.count),
        simulated=float(app.solver.t),
        wall=app.solver.wall,
        error=100.0 * float(numpy.mean(results["l1"][1:])),
    )


def timed(solve):
    """Solver.solve, which keeps the wall seconds of its steps, a few outputs among them."""

    def solve_and_time(self, *arguments, **named):
        begin = time.perf_counter()
        solve(self, *arguments, **named)
        self.wall = time.perf_counter() - begin

    return solve_and_time


def main():
    case, repeats, resolutions = sys.argv[1], int(sys.argv[2]), [int(n) for n in sys.argv[3:]]
    try:
        import matplotlib

        matplotlib.use("Agg")
        from pysph.examples.taylor_green import TaylorGreen
        from pysph.solver.solver import Solver
    except ImportError as reason:
        print(f"MISSING {sys.executable} has no pysph ({reason})")
        return
    if case != "taylor_green_2d":
        print(f"MISSING pysph_cases.py has no case {case}")
        return
    from importlib.metadata import version

    program = "PySPH " + version("pysph")
    Solver.solve = timed(Solver.solve)
    for n in resolutions:
        for method, scheme in METHODS.items():
            for _ in range(repeats):
                with tempfile.TemporaryDirectory() as folder:
                    told = run(TaylorGreen, scheme, n, folder)
                point = dict(program=program, method=method, resolution=n, **told)
                print("\nPOINT " + json.dumps(point), flush=True)


main()

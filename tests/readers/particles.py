"""Opens a run's particle files with the readers that people use, and compares every value with the NumPy arrays.

particles.py RUN FPS FRAME..."""
import contextlib
import io
import json
import subprocess
import sys
import xml.etree.ElementTree as xml
from pathlib import Path

import meshio
import numpy as np
import pysplashsurf.bgeo  # registers the reader of Blender's sequence loader
import trimesh
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

run, fps, frames = Path(sys.argv[1]), float(sys.argv[2]), [int(f) for f in sys.argv[3:]]
SCALARS = ["id", "density", "pressure", "contacts"]


def flat_to_space(vectors):
    return np.pad(vectors, ((0, 0), (0, 3 - vectors.shape[1])))


def expect(what, found, wanted):
    assert found.shape == wanted.shape, f"{what}: shape {found.shape} instead of {wanted.shape}"
    same = np.array_equal(np.asarray(found), np.asarray(wanted))
    assert same, f"{what}: differs by {np.abs(found.astype(float) - wanted.astype(float)).max()}"


def splashsurf_positions(path):
    out = path.with_name(path.name + ".json")
    command = [str(Path(sys.executable).with_name("pysplashsurf")), "-q", "convert", "--particles", path, "-o", out]
    subprocess.run(command, check=True)
    return np.array(json.loads(out.read_text()), dtype=np.float32)


def arrays(frame):
    folder = run / f"particles_{frame:06}"
    found = {path.stem: np.load(path) for path in folder.glob("*.npy")}
    assert np.array_equal(found["id"], np.arange(len(found["id"]))), "rows are in order of id"
    found["position"] = flat_to_space(found["position"])
    found["velocity"] = flat_to_space(found["velocity"])
    return found


def check_vtk(path, wanted, time):
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    assert reader.GetErrorCode() == 0, f"{path}: VTK error {reader.GetErrorCode()}"
    data = reader.GetOutput()
    expect("vtk points", vtk_to_numpy(data.GetPoints().GetData()), wanted["position"])
    assert data.GetNumberOfVerts() == len(wanted["id"]), "one vertex cell a point"
    for name in ["velocity", *SCALARS]:
        expect(f"vtk {name}", vtk_to_numpy(data.GetPointData().GetArray(name)), wanted[name])
    found = data.GetFieldData().GetArray("TimeValue").GetValue(0)
    assert abs(found - time) < 1e-12, f"vtk time {found} instead of {time}"


def check_ply(path, wanted):
    cloud = trimesh.load(path)
    single = wanted["position"].astype(np.float32)
    expect("trimesh points", np.asarray(cloud.vertices).astype(np.float32), single)
    rows = cloud.metadata["_ply_raw"]["vertex"]["data"]
    for axis, name in enumerate(["vx", "vy", "vz"]):
        expect(f"ply {name}", rows[name].ravel(), wanted["velocity"][:, axis])
    for name in SCALARS:
        expect(f"ply {name}", rows[name].ravel(), wanted[name])
    expect("splashsurf's points of a PLY file", splashsurf_positions(path), single)


def check_bgeo(path, wanted):
    single = wanted["position"].astype(np.float32)
    expect("splashsurf's points of a BGEO file", splashsurf_positions(path), single)
    with contextlib.redirect_stdout(io.StringIO()):
        mesh = meshio.read(path, "bgeo")
    expect("bgeo points", mesh.points, single)
    expect("bgeo v", mesh.point_data["v"], wanted["velocity"])
    for name in SCALARS:
        expect(f"bgeo {name}", mesh.point_data[name], wanted[name])


for frame in frames:
    wanted = arrays(frame)
    stem = run / f"particles_{frame:06}"
    assert np.abs(wanted["velocity"]).max() > 0 or frame == 0, "particles move"
    check_vtk(stem.with_suffix(".vtp"), wanted, frame / fps)
    check_ply(stem.with_suffix(".ply"), wanted)
    check_bgeo(stem.with_suffix(".bgeo"), wanted)

sets = xml.parse(run / "particles.pvd").getroot().iter("DataSet")
listed = [(s.get("file"), float(s.get("timestep"))) for s in sets]
expected = [(f"particles_{frame:06}.vtp", frame / fps) for frame in frames]
assert [name for name, _ in listed] == [name for name, _ in expected], listed
assert np.allclose([t for _, t in listed], [t for _, t in expected], rtol=0, atol=1e-12), listed
print(f"{len(frames)} frames agree")

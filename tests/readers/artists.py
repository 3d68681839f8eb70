"""Opens what `surface` and `usd` made of a run with Pixar's library and trimesh, and compares it with the NumPy arrays.

artists.py RUN GLBS CLIPS ONE_FILE FPS FRAME..."""
import sys
from pathlib import Path

import numpy as np
import trimesh
from pxr import Usd, UsdGeom

run, glbs, clips, one_file = map(Path, sys.argv[1:5])
fps, frames = float(sys.argv[5]), [int(f) for f in sys.argv[6:]]


def expect(what, found, wanted, tolerance=0.0):
    found, wanted = np.asarray(found, dtype=float), np.asarray(wanted, dtype=float)
    assert found.shape == wanted.shape, f"{what}: shape {found.shape} instead of {wanted.shape}"
    error = np.abs(found - wanted).max(initial=0)
    assert error <= tolerance, f"{what}: differs by {error}"


def placed(prim, points, frame):
    """In the scene's own coordinates: USD's matrices stand behind row vectors."""
    matrix = np.array(UsdGeom.Xformable(prim).ComputeLocalToWorldTransform(frame))
    return np.asarray(points, dtype=float) @ matrix[:3, :3] + matrix[3, :3]


def check_stage(path):
    stage = Usd.Stage.Open(str(path / "scene.usda"))
    assert UsdGeom.GetStageUpAxis(stage) == "Y" and UsdGeom.GetStageMetersPerUnit(stage) == 1
    assert stage.GetTimeCodesPerSecond() == fps and stage.GetEndTimeCode() == frames[-1]
    assert UsdGeom.Camera(stage.GetPrimAtPath("/World/camera")).GetCamera(0).frustum.nearFar.min > 0
    for frame in frames:
        arrays = {name: np.load(run / f"particles_{frame:06}" / f"{name}.npy") for name in ["position", "velocity", "id", "density"]}
        particles = UsdGeom.Points(stage.GetPrimAtPath("/World/particles"))
        expect("points", placed(particles, particles.GetPointsAttr().Get(frame), frame), arrays["position"], 1e-6)
        expect("velocities", particles.GetVelocitiesAttr().Get(frame), arrays["velocity"])
        expect("ids", particles.GetIdsAttr().Get(frame), arrays["id"])
        density = UsdGeom.PrimvarsAPI(particles).GetPrimvar("density")
        assert density.GetInterpolation() == "vertex"
        expect("density", density.Get(frame), arrays["density"])
        assert len(particles.GetWidthsAttr().Get(frame)) == 1 and particles.GetWidthsInterpolation() == "constant"

        mesh = UsdGeom.Mesh(stage.GetPrimAtPath("/World/surface"))
        wanted = trimesh.load(run / f"surface_{frame:06}.ply", process=False)
        points, triangles = mesh.GetPointsAttr().Get(frame), mesh.GetFaceVertexIndicesAttr().Get(frame)
        expect("vertices", placed(mesh, points, frame), wanted.vertices, 1e-6)
        expect("triangles", np.reshape(triangles, (-1, 3)), wanted.faces)
        assert set(mesh.GetFaceVertexCountsAttr().Get(frame)) == {3}
        valid, why = UsdGeom.Mesh.ValidateTopology(triangles, mesh.GetFaceVertexCountsAttr().Get(frame), len(points))
        assert valid, why
        assert len(mesh.GetNormalsAttr().Get(frame)) == len(mesh.GetVelocitiesAttr().Get(frame)) == len(points)
        low, high = mesh.GetExtentAttr().Get(frame)
        expect("extent", [low, high], [np.min(points, axis=0), np.max(points, axis=0)])
    obstacle = stage.GetPrimAtPath("/World/obstacles").GetChildren()
    return len(obstacle)


def check_glb(frame):
    wanted = trimesh.load(run / f"surface_{frame:06}.ply", process=False)
    found = trimesh.load(glbs / f"surface_{frame:06}.glb", process=False).to_geometry()
    assert found.is_watertight and found.is_winding_consistent and found.volume > 0
    expect("glb vertices", found.vertices, wanted.vertices, 1e-6)
    expect("glb triangles", found.faces, wanted.faces)
    expect("glb velocities", found.vertex_attributes["_VELOCITY"].shape, wanted.vertices.shape)


obstacles = {check_stage(clips), check_stage(one_file)}
assert len(obstacles) == 1
for frame in frames:
    check_glb(frame)
print(f"{len(frames)} frames agree, {obstacles.pop()} obstacles")

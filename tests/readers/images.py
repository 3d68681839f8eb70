"""Opens the extra images of a run with OpenEXR, and compares them with the NumPy arrays.

images.py RUN FRAME..."""
import sys
from pathlib import Path

import numpy as np
import OpenEXR

run, frames = Path(sys.argv[1]), [int(frame) for frame in sys.argv[2:]]
for frame in frames:
    image = OpenEXR.File(str(run / f"frame_{frame:06}.exr"), separate_channels=True)
    channels = {name: channel.pixels for name, channel in image.channels().items()}
    types = {name: str(pixels.dtype) for name, pixels in channels.items()}
    layers = [f"{layer}.{axis}" for layer in ("normal", "velocity") for axis in "XYZ"]
    assert set(types) == {*"RGBAZ", "id", "motion.X", "motion.Y", *layers}, types
    assert types["R"] == types["normal.X"] == "float16" and types["Z"] == types["velocity.X"] == "float32"
    assert types["id"] == "uint32" and {pixels.shape for pixels in channels.values()} == {(90, 160)}
    ids = channels["id"]
    velocity = np.load(run / f"particles_{frame:06}" / "velocity.npy")
    seen = (ids > 0) & (ids <= len(velocity))
    assert seen.sum() > 500 and (ids == 2**32 - 1).sum() > 50, "neither particles nor the obstacle are seen"
    found = np.stack([channels[f"velocity.{axis}"][seen] for axis in "XYZ"], axis=1)
    assert np.array_equal(found, velocity[ids[seen] - 1]), "velocities differ"
    lengths = np.sqrt(sum(channels[f"normal.{axis}"][seen].astype(float) ** 2 for axis in "XYZ"))
    assert np.abs(lengths - 1).max() < 2e-3
    assert channels["Z"][seen].max() < 100 and channels["Z"].max() == 1e10
print(f"{len(frames)} frames agree")

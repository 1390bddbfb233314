"""Prints mean, median and relMSE of pictures of one scene by several seeds: blender -b -P error.py -- A.exr B.exr ...

relMSE: variance over the seeds / (mean^2 + 0.01), the mean over pixels and channels.
"""
import sys

import bpy
import numpy

pictures = []
for file in sys.argv[sys.argv.index("--") + 1:]:
    image = bpy.data.images.load(file)
    image.colorspace_settings.name = "Raw"
    values = numpy.empty(len(image.pixels), dtype=numpy.float32)
    image.pixels.foreach_get(values)
    pictures.append(values.reshape(-1, 4)[:, :3].astype(float))
stack = numpy.stack(pictures)
mean = stack.mean(0)
relative = stack.var(0, ddof=1) / (mean * mean + 0.01)
print("RESULT", mean.mean(), numpy.median(mean), relative.mean())

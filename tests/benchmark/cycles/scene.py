"""Renders a scene.json of `likeness make scene` with Cycles: blender -b --factory-startup -P scene.py -- SCENE OUT.exr SPP SEED SIZE THREADS

Knows what cornell, ggx_sphere and plastic_sphere are made of: PLY meshes and spheres; lambert, ggx and callisto at its
defaults; rectangles of light; an environment of one color. Coordinates stay y up.
"""
import json
import math
import os
import sys

import bpy
import mathutils

scene_file, out, spp, seed, size, threads = sys.argv[sys.argv.index("--") + 1:]
description = json.load(open(scene_file))
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.preferences.addon_enable(module="io_mesh_ply")
scene = bpy.context.scene

render, cycles = scene.render, scene.cycles
render.engine, cycles.device, cycles.samples, cycles.seed = "CYCLES", "CPU", int(spp), int(seed)
cycles.use_denoising = cycles.use_adaptive_sampling = False
cycles.pixel_filter_type, cycles.sample_clamp_indirect, cycles.blur_glossy = "BOX", 0, 0
cycles.light_sampling_threshold = 0
cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = 64
render.threads_mode, render.threads = "FIXED", int(threads)
render.resolution_x = render.resolution_y = int(size)
render.image_settings.file_format, render.image_settings.color_depth = "OPEN_EXR", "32"
render.filepath = out
scene.view_settings.view_transform = "Raw"


def color(value):
    return [float(v) for v in (value if isinstance(value, list) else [value] * 3)]


def material(row):
    made = bpy.data.materials.new("material")
    made.use_nodes = True
    nodes = made.node_tree.nodes
    nodes.clear()
    p, model = row.get("parameters", {}), row.get("model", "callisto")
    kinds = {"lambert": "ShaderNodeBsdfDiffuse", "ggx": "ShaderNodeBsdfGlossy", "callisto": "ShaderNodeBsdfPrincipled"}
    shader = nodes.new(kinds[model])
    if model == "lambert":
        shader.inputs["Color"].default_value = color(p["base_color"]) + [1]
    elif model == "ggx":
        shader.distribution = "GGX"
        shader.inputs["Color"].default_value = color(p["f0"]) + [1]
        shader.inputs["Roughness"].default_value = p["roughness"]
    else:
        for name, key, usual in (("Roughness", "roughness", 0.5), ("Specular", "specular", 0.5), ("Metallic", "metallic", 0)):
            shader.inputs[name].default_value = p.get(key, usual)
        shader.inputs["Base Color"].default_value = color(p.get("base_color", 0.5)) + [1]
    output = nodes.new("ShaderNodeOutputMaterial")
    made.node_tree.links.new(shader.outputs[0], output.inputs[0])
    return made


materials = {name: material(row) for name, row in description["materials"].items()}
for instance in description["instances"]:
    mesh = description["meshes"][instance["mesh"]]
    if "file" in mesh:
        bpy.ops.import_mesh.ply(filepath=os.path.join(os.path.dirname(scene_file), mesh["file"]))
    else:
        assert mesh["shape"] == "sphere"
        bpy.ops.mesh.primitive_uv_sphere_add(segments=256, ring_count=128, radius=1)
        bpy.ops.object.shade_smooth()
    thing = bpy.context.object
    thing.matrix_world = mathutils.Matrix.Identity(4)
    thing.data.materials.clear()
    thing.data.materials.append(materials[instance["material"]])

for row in description.get("lights", []):
    u, v = mathutils.Vector(row["half_u"]), mathutils.Vector(row["half_v"])
    radiance = color(row["strength"])
    light = bpy.data.lights.new("light", "AREA")
    light.shape, light.size, light.size_y = "RECTANGLE", 2 * u.length, 2 * v.length
    light.color = [c / max(radiance) for c in radiance]
    light.energy = 4 * max(radiance) * light.size * light.size_y  # Cycles: radiance = power / (4 area)
    normal = u.cross(v).normalized()
    x, z = u.normalized(), -normal
    thing = bpy.data.objects.new("light", light)
    axes = mathutils.Matrix((x, z.cross(x), z)).transposed()
    thing.matrix_world = mathutils.Matrix.Translation(row["position"]) @ axes.to_4x4()
    scene.collection.objects.link(thing)

if "environment" in description:
    scene.world = bpy.data.worlds.new("world")
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs[0].default_value = color(description["environment"]["radiance"]) + [1]

row = description["cameras"][0]
camera = bpy.data.cameras.new("camera")
camera.angle = (math.radians(row["fov_deg"]) if "fov_deg" in row
                else 2 * math.atan(0.5 * row["sensor_mm"] / row["focal_mm"]))
camera.clip_start = 1e-3
z = (mathutils.Vector(row["position"]) - mathutils.Vector(row["target"])).normalized()
x = mathutils.Vector((0, 1, 0)).cross(z).normalized()
thing = bpy.data.objects.new("camera", camera)
thing.matrix_world = (mathutils.Matrix.Translation(row["position"])
                      @ mathutils.Matrix((x, z.cross(x), z)).transposed().to_4x4())
scene.collection.objects.link(thing)
scene.camera = thing
bpy.ops.render.render(write_still=True)

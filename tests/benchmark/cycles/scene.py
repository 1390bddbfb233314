"""Renders a scene.json of `likeness make scene` with Cycles: blender -b --factory-startup -P scene.py -- SCENE OUT.exr SPP SEED SIZE THREADS

Knows what the scenes of compare.py are made of: PLY and glTF meshes and spheres; lambert, ggx and callisto at its defaults,
its base color a picture or not; rectangles of light; an environment of one color or a picture. Coordinates stay y up.
"""
import json
import math
import os
import sys

import bpy
import mathutils
import numpy

for name, kind in (("bool", bool), ("int", int), ("float", float), ("object", object)):
    setattr(numpy, name, kind)  # names that Blender 3.4's reader of glTF has of an older numpy

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
        base_color = p.get("base_color", 0.5)
        if isinstance(base_color, dict):
            picture = nodes.new("ShaderNodeTexImage")
            picture.image = bpy.data.images.load(base_color["file"])
            made.node_tree.links.new(picture.outputs["Color"], shader.inputs["Base Color"])
        else:
            shader.inputs["Base Color"].default_value = color(base_color) + [1]
    output = nodes.new("ShaderNodeOutputMaterial")
    made.node_tree.links.new(shader.outputs[0], output.inputs[0])
    return made


def add_mesh(mesh):
    """The mesh as the active object, as it is in its file: y up, and its own v."""
    if "file" not in mesh:
        assert mesh["shape"] == "sphere"
        bpy.ops.mesh.primitive_uv_sphere_add(segments=256, ring_count=128, radius=1)
        bpy.ops.object.shade_smooth()
        return
    file = os.path.join(os.path.dirname(scene_file), mesh["file"])
    if file.endswith(".ply"):
        bpy.ops.import_mesh.ply(filepath=file)
        return
    bpy.ops.import_scene.gltf(filepath=file)
    (thing,) = [o for o in scene.objects if o.type == "MESH" and o.data.uv_layers]
    bpy.context.view_layer.objects.active = thing
    turned = mathutils.Matrix.Rotation(math.radians(-90), 4, "X") @ thing.matrix_world  # the reader turned y to z
    thing.parent = None
    thing.data.transform(turned)
    if mesh.get("flip_v"):
        for corner in thing.data.uv_layers.active.data:
            corner.uv.y = 1 - corner.uv.y


materials = {name: material(row) for name, row in description["materials"].items()}
for instance in description["instances"]:
    add_mesh(description["meshes"][instance["mesh"]])
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
    tree = scene.world.node_tree
    background = tree.nodes["Background"]
    if "file" in description["environment"]:
        # The middle of the picture is -z here and +x in Blender, what is right of it +x here and -y in Blender.
        direction, parts, place = (tree.nodes.new("ShaderNode" + kind) for kind in ("TexCoord", "SeparateXYZ", "CombineXYZ"))
        tree.links.new(direction.outputs["Generated"], parts.inputs[0])
        for source, sign, target in (("Z", -1, "X"), ("X", -1, "Y"), ("Y", 1, "Z")):
            product = tree.nodes.new("ShaderNodeMath")
            product.operation, product.inputs[1].default_value = "MULTIPLY", sign
            tree.links.new(parts.outputs[source], product.inputs[0])
            tree.links.new(product.outputs[0], place.inputs[target])
        picture = tree.nodes.new("ShaderNodeTexEnvironment")
        picture.image = bpy.data.images.load(description["environment"]["file"])
        tree.links.new(place.outputs[0], picture.inputs["Vector"])
        tree.links.new(picture.outputs["Color"], background.inputs[0])
    else:
        background.inputs[0].default_value = color(description["environment"]["radiance"]) + [1]

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

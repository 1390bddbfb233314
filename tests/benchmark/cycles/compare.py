#!/usr/bin/env python3
"""The path tracer beside Cycles on the same scenes, one thread, interleaved.

    tests/benchmark/cycles/compare.py build/release/likeness [--spp 64] [--repeats 3] [--scenes cornell head ...]

Needs `blender` (Debian's package: Cycles 3.4) and `oiiotool`. For each scene it prints the CPU seconds that one more sample a pixel costs
(a render of N + 1 samples minus one of 1, whole processes), relMSE over the seeds of the repeats (variance / (mean^2 +
0.01)), and cost = relMSE x samples x CPU seconds a sample: what an error of 1 would take. Mean and median say whether both
see the same picture. 256 x 256, at most 64 bounces. The head scan needs the shared data (--data); without it that scene is
left out.
"""
import argparse
import json
import os
import resource
import statistics
import subprocess
import sys
import tempfile

# Blender looks for its Python's packages beside the first python3 of PATH: that must be the system's.
SYSTEM = dict(os.environ, PATH="/usr/local/bin:/usr/bin:/bin")
HERE = os.path.dirname(os.path.abspath(__file__))


def head_scene(data, folder):
    """The head scan with its colors, no bumps, under a photo of a studio; False if the data is not there."""
    mesh, colors = (f"{data}/heads/lee-perry-smith/{name}" for name in ("LeePerrySmith.glb", "Map-COL.jpg"))
    studio = f"{data}/hdri/studio_small_03_1k.hdr"
    if not all(os.path.exists(file) for file in (mesh, colors, studio)):
        return False
    os.makedirs(folder, exist_ok=True)
    camera = {"position": [0, 0.2, 12], "target": [0, 0.2, 0], "fov_deg": 30, "width": 256, "height": 256}
    with open(f"{folder}/scene.json", "w") as file:
        json.dump({"format": "likeness scene", "version": 1, "name": "head", "cameras": [camera],
                   "meshes": {"head": {"file": mesh, "flip_v": True}},
                   "materials": {"skin": {"model": "callisto", "parameters": {"base_color": {"file": colors}}}},
                   "instances": [{"mesh": "head", "material": "skin"}], "environment": {"file": studio}}, file)
    return True


def cpu_seconds(command):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(command, capture_output=True, text=True, env=SYSTEM)
    if done.returncode != 0:
        sys.exit("compare.py: failed: " + " ".join(command) + "\n" + done.stderr[-2000:] + done.stdout[-2000:])
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, done.stdout


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("likeness")
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--scenes", nargs="+", default=["ggx_sphere", "plastic_sphere", "cornell", "head"])
    parser.add_argument("--data", default=os.path.join(HERE, "../../../../shared/data"))
    options = parser.parse_args()

    with tempfile.TemporaryDirectory() as folder:
        print(f"{'scene':16}{'renderer':10}{'CPU s/spp':>10}{'range':>16}{'mean':>9}{'median':>9}{'relMSE':>10}{'cost':>10}")
        for scene in options.scenes:
            if scene != "head":
                cpu_seconds([options.likeness, "make", "scene", scene, "--out", f"{folder}/{scene}"])
            elif not head_scene(os.path.abspath(options.data), f"{folder}/{scene}"):
                print(f"{scene:16}left out: the head scan is not in {options.data}")
                continue
            file = f"{folder}/{scene}/scene.json"

            def ours(spp, seed, out):
                return cpu_seconds([options.likeness, "render", file, "--spp", str(spp), "--seed", str(seed), "--threads", "1",
                                    "--size", "256x256", "--no-png", "--out", out])[0]

            def cycles(spp, seed, out):
                return cpu_seconds(["blender", "-b", "--factory-startup", "-P", f"{HERE}/scene.py", "--", file, out, str(spp),
                                    str(seed), "256", "1"])[0]

            renderers = {"likeness": ours, "cycles": cycles}
            costs = {name: [] for name in renderers}
            for seed in range(1, options.repeats + 1):
                for name, render in renderers.items():
                    least = render(1, seed, f"{folder}/least.exr")
                    whole = render(options.spp + 1, seed, f"{folder}/{scene}_{name}_{seed}.exr")
                    costs[name].append((whole - least) / options.spp)
            for name in renderers:
                pictures = [f"{folder}/{scene}_{name}_{seed}.exr" for seed in range(1, options.repeats + 1)]
                for picture in pictures:  # the layers beside it left out, which Blender would take for a multilayer picture
                    cpu_seconds(["oiiotool", picture, "--ch", "R,G,B", "-o", picture])
                told = cpu_seconds(["blender", "-b", "--factory-startup", "-P", f"{HERE}/error.py", "--", *pictures])[1]
                found = [line for line in told.splitlines() if line.startswith("RESULT")]
                if not found:
                    sys.exit("compare.py: no error of " + " ".join(pictures) + ":\n" + told)
                mean, median, error = map(float, found[0].split()[1:])
                each = statistics.median(costs[name])
                spread = f"{min(costs[name]):.4f}-{max(costs[name]):.4f}"
                print(f"{scene:16}{name:10}{each:10.4f}{spread:>16}{mean:9.4f}{median:9.4f}{error:10.2e}"
                      f"{error * (options.spp + 1) * each:10.2e}", flush=True)


if __name__ == "__main__":
    main()

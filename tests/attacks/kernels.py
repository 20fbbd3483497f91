"""GPU kernels under the address and undefined-behaviour sanitizers, in whole runs on tests/stand_in."""

import os
import pathlib
import shutil
import subprocess

import scene_hashes

from .scenes import INPUTS
from .verdict import ROOT

SCENES = [
    ("grains/box.toml", ["grains.0.count=60", "time.end=0.02", "output.frames=1"]),
    ("grains/two_laws.toml", ["time.end=0.02", "output.frames=1"]),
    ("grains/bonded_stone/scene.toml", ["time.end=0.002", "output.frames=1"]),
    ("grains/drum.toml", ["time.end=0.01", "output.frames=1"]),
    ("grains/shear.toml", ["time.end=0.005", "output.frames=1"]),
    ("grains/servo.toml", ["time.end=0.01", "output.frames=1"]),
    ("verify/asperities/scene.toml", ["time.end=0.02", "output.frames=1"]),
    ("grains/column.toml", ["time.end=0.005", "grains.0.count=300", "output.frames=1"]),
]


def sanitizer():
    """Run-time library of the address sanitizer, if any."""
    found = subprocess.run(["cc", "-print-file-name=libasan.so"], capture_output=True, text=True, check=False).stdout.strip()
    return os.path.realpath(found) if os.path.isabs(found) else None


def kernels(bench, rng):
    """Instrumented runs must match the CPU byte for byte."""
    library = sanitizer() if shutil.which("cc") else None
    if not library:
        print("kernels: left out, no C compiler (cc) with an address sanitizer")
        return
    folder = bench.fresh("libraries")
    folder.mkdir()
    for source, made in (("driver.c", "libcuda.so.1"), ("compiler.c", "libnvrtc.so.13")):
        options = ["-std=gnu11", "-O1", "-shared", "-fPIC", "-o", folder / made, ROOT / "tests/stand_in" / source, "-ldl"]
        subprocess.run(["cc", *options], check=True)
    # The sanitizers end the process.
    wrapper = folder / "cc"
    watched = "-fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer -g"
    wrapper.write_text(f'#!/bin/sh\nunset LD_PRELOAD\nexec {shutil.which("cc")} {watched} "$@"\n')
    wrapper.chmod(0o755)
    env = {
        "LD_LIBRARY_PATH": str(folder),
        "STAND_IN_FOLDER": str(folder),
        "PATH": f"{folder}:{os.environ['PATH']}",
        "LD_PRELOAD": library,
        "ASAN_OPTIONS": "detect_leaks=0:exitcode=99:allocator_may_return_null=1",
        "UBSAN_OPTIONS": "print_stacktrace=1:exitcode=99",
    }
    for scene, sets in SCENES:
        words = ["run", INPUTS / scene, *(f"--set={s}" for s in sets), "--quiet", "--threads", "2", "--out"]
        device, processor = bench.fresh("device"), bench.fresh("processor")
        code, _ = bench.attempt(*words, device, "--device", "gpu", out=device, codes={0}, env=env, soon=300)
        made = [p for p in pathlib.Path(folder).glob("*.so") if b"__asan_report" in p.read_bytes()]
        if not made:
            bench.fault([*words, device], "no kernel was compiled with the sanitizers")
        for path in folder.glob("[0-9]*"):
            path.unlink()
        bench.attempt(*words, processor, codes={0}, soon=120)
        if code == 0 and scene_hashes.files(device) != scene_hashes.files(processor):
            bench.fault([*words, device], "the device's results differ from the processor's")
        yield

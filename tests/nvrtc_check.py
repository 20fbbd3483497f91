"""Compiles the kernel source with NVRTC for two GPU generations, without a GPU.

    cargo run --release -p trackbed-dem --example kernels -- FOLDER
    pip install nvidia-cuda-nvrtc==13.0.88
    python3 tests/nvrtc_check.py FOLDER

No fused multiply-add (`--fmad=false`), for results bitwise equal to the CPU. Prints registers and spilled bytes by
kernel. Exit code 1 after a compiler error or a contraction.
"""

import ctypes
import glob
import os
import re
import sys
import sysconfig
import time

ARCHITECTURES = ["80", "90"]


def load():
    libraries = os.path.join(sysconfig.get_paths()["purelib"], "nvidia", "**")
    found = [sorted(glob.glob(os.path.join(libraries, n), recursive=True)) for n in ("libnvrtc-builtins.so*", "libnvrtc.so*")]
    if not all(found):
        sys.exit("nvidia-cuda-nvrtc is not installed in this environment")
    # NVRTC opens this library by name.
    ctypes.CDLL(found[0][0], mode=ctypes.RTLD_GLOBAL)
    return ctypes.CDLL(found[1][0])


NVRTC = load()


def text_of(program, what):
    size = ctypes.c_size_t()
    getattr(NVRTC, f"nvrtcGet{what}Size")(program, ctypes.byref(size))
    buffer = ctypes.create_string_buffer(max(size.value, 1))
    getattr(NVRTC, f"nvrtcGet{what}")(program, buffer)
    return buffer.value.decode()


def compiled(source, name, options):
    """PTX (None after an error) and log."""
    program = ctypes.c_void_p()
    NVRTC.nvrtcCreateProgram(ctypes.byref(program), source, name.encode(), 0, None, None)
    array = (ctypes.c_char_p * len(options))(*[o.encode() for o in options])
    code = NVRTC.nvrtcCompileProgram(program, len(options), array)
    log = text_of(program, "ProgramLog")
    ptx = text_of(program, "PTX") if code == 0 else None
    NVRTC.nvrtcDestroyProgram(ctypes.byref(program))
    return ptx, log


def contractions(ptx):
    return len(re.findall(r"\bfma\.\w+\.f64\b", ptx))


def kernels(log):
    """Name, registers and spilled bytes of each kernel."""
    rows, name, spilled = [], "", 0
    for line in log.splitlines():
        if found := re.search(r"Compiling entry function '(\w+)'", line):
            name = found[1]
        elif found := re.search(r"(\d+) bytes spill stores, (\d+) bytes spill loads", line):
            spilled = int(found[1]) + int(found[2])
        elif found := re.search(r"Used (\d+) registers", line):
            rows.append((name, int(found[1]), spilled))
    return rows


def check(path):
    source = open(path, "rb").read()
    name, wrong = os.path.basename(path), []
    for arch in ARCHITECTURES:
        begun = time.process_time()
        options = [f"--gpu-architecture=sm_{arch}", "--fmad=false", "--ptxas-options=-v"]
        ptx, log = compiled(source, name, options)
        if ptx is None:
            print(log)
            wrong.append(f"{name}: refused for sm_{arch}")
            continue
        rows = kernels(log)
        parts = ", ".join(f"{n} {r} registers, {s} B spilled" for n, r, s in rows)
        print(f"{name} sm_{arch}: {parts or 'no registers reported'}; {time.process_time() - begun:.1f} s")
        if not ptx.strip():
            wrong.append(f"{name}: no PTX for sm_{arch}")
        if contractions(ptx):
            wrong.append(f"{name}: {contractions(ptx)} contractions for sm_{arch}")
        if not re.search(r"\bmul(\.rn)?\.f64\b", ptx):
            wrong.append(f"{name}: no product of doubles in the PTX for sm_{arch}")
    return wrong


def main():
    paths = sorted(glob.glob(os.path.join(sys.argv[1], "*.cu")))
    if not paths:
        sys.exit(f"no kernels in {sys.argv[1]}")
    version = ctypes.c_int(), ctypes.c_int()
    NVRTC.nvrtcVersion(ctypes.byref(version[0]), ctypes.byref(version[1]))
    print(f"NVRTC {version[0].value}.{version[1].value}")
    # Positive control: the default options contract.
    ptx, log = compiled(open(paths[0], "rb").read(), "as_usual.cu", ["--gpu-architecture=sm_90"])
    wrong = [] if ptx and contractions(ptx) else [f"no contraction is found where there must be some\n{log}"]
    for path in paths:
        wrong += check(path)
    print("\n".join(wrong) or f"{len(paths)} texts, sm_{', sm_'.join(ARCHITECTURES)}: no contraction")
    sys.exit(1 if wrong else 0)


main()

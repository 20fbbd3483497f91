"""Makes and tests the archive of a release.

    python3 release/archive.py pages PROGRAM DIRECTORY     manual pages (man1/) and completions of PROGRAM
    python3 release/archive.py make PROGRAM [--target NAME] [--out DIRECTORY] [--strip]
    python3 release/archive.py test ARCHIVE                unpacks, checks the content, runs the demo

`make` prints the archive's path, size and SHA-256, and fails above LARGEST. The bytes depend on the content only. `--strip`
calls the system's strip; releases are stripped by cargo (CARGO_PROFILE_RELEASE_STRIP).
"""
import argparse, gzip, hashlib, io, os, platform, re, shutil, subprocess, sys, tarfile, tempfile, zipfile

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
LARGEST = 15_000_000  # bytes
DOCUMENTS = ["README.md", "CHANGELOG.md", "CITATION.cff", "LICENSE-APACHE", "LICENSE-MIT"]
# Scenes that README runs, with their files; `trackbed new` writes all templates.
INPUTS = ["track/cyclic", "ballast/granite.toml", "data/ballast_stones.toml"]
SHELLS = {"bash": "trackbed.bash", "zsh": "_trackbed", "fish": "trackbed.fish", "elvish": "trackbed.elv", "powershell": "_trackbed.ps1"}
TIME = (1980, 1, 1, 0, 0, 0)  # the first that a zip file can hold


def call(*words, **options):
    done = subprocess.run(words, stdout=subprocess.PIPE, text=True, encoding="utf-8", **options)
    if done.returncode:
        sys.exit(f"{' '.join(words)}: exit code {done.returncode}")
    return done.stdout


def pages(program, folder):
    call(program, "manual", os.path.join(folder, "man1"))
    os.makedirs(os.path.join(folder, "completions"), exist_ok=True)
    for shell, name in SHELLS.items():
        with open(os.path.join(folder, "completions", name), "w", encoding="utf-8", newline="\n") as file:
            file.write(call(program, "completions", shell))


def host():
    system = {"Linux": "linux", "Darwin": "macos", "Windows": "windows"}.get(platform.system(), platform.system().lower())
    processor = {"AMD64": "x86_64", "arm64": "aarch64"}.get(platform.machine(), platform.machine())
    return f"{system}-{processor}"


def content(program, folder, strip):
    """Fills `folder`: program, manual pages, completions, documents, inputs."""
    own = os.path.join(folder, "trackbed.exe" if program.endswith(".exe") else "trackbed")
    shutil.copy(program, own)
    if strip:
        call("strip", own)
    pages(os.path.abspath(program), folder)
    for name in DOCUMENTS:
        shutil.copy(os.path.join(ROOT, name), folder)
    for name in INPUTS:
        source, target = os.path.join(ROOT, "inputs", name), os.path.join(folder, "inputs", name)
        os.makedirs(os.path.dirname(target), exist_ok=True)
        (shutil.copytree if os.path.isdir(source) else shutil.copy)(source, target)


def files(folder):
    found = [os.path.join(at, name) for at, _, names in os.walk(folder) for name in names]
    return sorted((os.path.relpath(file, folder).replace(os.sep, "/"), file) for file in found)


def mode(name):
    return 0o755 if os.path.basename(name) in ("trackbed", "trackbed.exe") else 0o644


def write_zip(base, folder, file):
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as out:
        for name, path in files(folder):
            entry = zipfile.ZipInfo(f"{base}/{name}", TIME)
            entry.external_attr, entry.compress_type = mode(name) << 16, zipfile.ZIP_DEFLATED
            out.writestr(entry, open(path, "rb").read())


def write_tar(base, folder, file):
    with open(file, "wb") as raw, gzip.GzipFile("", "wb", 9, raw, mtime=0) as packed, tarfile.open(fileobj=packed, mode="w") as out:
        for name, path in files(folder):
            entry = tarfile.TarInfo(f"{base}/{name}")
            data = open(path, "rb").read()
            entry.size, entry.mode = len(data), mode(name)
            out.addfile(entry, io.BytesIO(data))


def make(program, target, out, strip):
    version = call(program, "--version").split()[1]
    base = f"trackbed-{version}-{target}"
    windows = target.startswith("windows")
    os.makedirs(out, exist_ok=True)
    file = os.path.join(out, base + (".zip" if windows else ".tar.gz"))
    with tempfile.TemporaryDirectory() as folder:
        content(program, folder, strip)
        (write_zip if windows else write_tar)(base, folder, file)
    data = open(file, "rb").read()
    print(f"{file}: {len(data) / 1e6:.1f} MB, SHA-256 {hashlib.sha256(data).hexdigest()}")
    if len(data) > LARGEST:
        sys.exit(f"{file}: found {len(data)} bytes, expected at most {LARGEST}")


def commands(program):
    """Commands in the help text."""
    text = call(program, "--help").split("Commands:")[1].split("Options:")[0]
    return [name for name in re.findall(r"^  (\w+) ", text, re.M) if name != "help"]


def test(archive):
    with tempfile.TemporaryDirectory() as folder:
        shutil.unpack_archive(archive, folder)
        (base,) = os.listdir(folder)
        base = os.path.join(folder, base)
        there = {name for name, _ in files(base)}
        program = os.path.join(base, "trackbed.exe" if "trackbed.exe" in there else "trackbed")
        os.chmod(program, 0o755)  # unpacking a zip file loses it
        wanted = set(DOCUMENTS) | {f"completions/{name}" for name in SHELLS.values()} | {"man1/trackbed.1"}
        wanted |= {f"man1/trackbed-{name}.1" for name in commands(program)}
        if missing := wanted - there:
            sys.exit(f"{archive}: found no {', '.join(sorted(missing))}")
        # In a folder and an environment of their own.
        environment = {k: v for k, v in os.environ.items() if k.upper() in ("SYSTEMROOT", "TEMP", "TMP")}
        options = {"cwd": folder, "env": environment}
        call(program, "check", os.path.join(base, "inputs/track/cyclic/scene.toml"), **options)
        call(program, "demo", "--no-view", "--out", "demo", **options)
        call(program, "report", "demo/results", **options)
        sizes = sum(os.path.getsize(path) for _, path in files(base))
        print(f"{archive}: {len(there)} files, {sizes / 1e6:.1f} MB unpacked; demo and report passed")


parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parts = parser.add_subparsers(dest="part", required=True)
part = parts.add_parser("pages")
part.add_argument("program")
part.add_argument("folder")
part = parts.add_parser("make")
part.add_argument("program")
part.add_argument("--target", default=host())
part.add_argument("--out", default="dist")
part.add_argument("--strip", action="store_true")
part = parts.add_parser("test")
part.add_argument("archive")
chosen = vars(parser.parse_args())
{"pages": pages, "make": make, "test": test}[chosen.pop("part")](**chosen)

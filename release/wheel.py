"""Tests a wheel in an environment of its own: python3 release/wheel.py WHEEL"""
import glob, os, subprocess, sys, tempfile, venv

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
# A pattern is expanded here: not every shell does it.
(wheel,) = glob.glob(sys.argv[1])
with tempfile.TemporaryDirectory() as folder:
    venv.create(folder, with_pip=True)
    programs = os.path.join(folder, "Scripts" if os.name == "nt" else "bin")
    python = os.path.join(programs, "python")
    environment = {k: v for k, v in os.environ.items() if k != "PYTHONPATH"}

    def call(*words):
        subprocess.run(words, cwd=folder, env=environment, check=True)

    call(python, "-m", "pip", "install", "--quiet", os.path.abspath(wheel), "pandas", "pytest")
    call(python, "-m", "pytest", "-q", os.path.join(ROOT, "python", "tests"), "-p", "no:cacheprovider", "--import-mode=importlib")
    call(os.path.join(programs, "trackbed"), "demo", "--no-view", "--out", "demo")
print(f"{wheel}: {os.path.getsize(wheel) / 1e6:.1f} MB; tests and demo passed")

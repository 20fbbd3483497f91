#!/usr/bin/env bash
# Checks that need a CUDA GPU; CI uses tests/stand_in.
#
#     tests/device_check.sh PROGRAM
#
# PROGRAM: target/release/trackbed. Without a build on this machine, ENGINE_TESTS and DEVICE_BENCH name the outputs of
#
#     cargo test --release --no-run -p trackbed-dem --features cuda --test engine
#     cargo bench --no-run --bench device
#
# Engine tests, grain-only and coupled runs against the CPU byte for byte, killed and resumed runs, rates of beds at
# rest. About ten minutes; stops at the first difference.
set -euo pipefail
program=$(realpath "$1")
tests=${ENGINE_TESTS:+$(realpath "$ENGINE_TESTS")}
bench=${DEVICE_BENCH:+$(realpath "$DEVICE_BENCH")}
cd "$(dirname "$0")/.."
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT

echo "== every bit of the engine's state"
if test -n "$tests"; then
    (cd dem && TRACKBED_DEVICE=cuda "$tests" device)
else
    TRACKBED_DEVICE=cuda cargo test --release -p trackbed-dem --features cuda --test engine device
fi

echo "== whole runs: the main job, other coupled ones, bonds, clumps, triangles, borders, a drum, a plate that is driven"
runs=(--only track-cyclic --only coupled- --only bonds- --only grains-servo --only grains-drum --only grains-column --only grains-shear)
python3 tests/scene_hashes.py record "$program" "$out/table" --jobs 4 "${runs[@]}"
python3 tests/scene_hashes.py compare "$program" "$out/table" --device "${runs[@]}"

echo "== runs that are killed"
python3 tests/random_kills.py "$program" --kills 10 --device --only track --only coupled --only bonds --only grains-servo

echo "== rates"
rate() { if test -n "$bench"; then "$bench" "$@"; else cargo bench --bench device -- "$@"; fi; }
rate --scene s1 --tiles 1,3,10 --steps 500
rate --scene s5 --tiles 1,3 --steps 500
rate --scene s3 --steps 500

#!/usr/bin/env bash
# Runs over MPI: identical files on 1 to 4 ranks and without MPI, checkpoints for any number of ranks, killed ranks.
# Needs the feature `mpi` and mpirun.
#
#   LIBCLANG_PATH=/usr/lib/llvm-14/lib cargo build --release --features mpi
#   tests/ranks_check.sh target/release/trackbed [spheres, default 6000]
set -euo pipefail
trackbed=$(realpath "$1")
count=${2:-6000}
repository=$(realpath "$(dirname "$0")/..")
folder=$(mktemp -d)
cd "$folder"
# OpenMPI rejects root and oversubscription by default.
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
ranks() { mpirun --oversubscribe --quiet -n "$@"; }
fail() { echo "FAILED: $*; see $folder"; exit 1; }

plane() { printf '[[walls]]\nkind = "plane"\nmaterial = "stone"\npoint = %s\nnormal = %s\n\n' "$1" "$2"; }
{
    cat <<EOF
title = "marbles and stones"

[[material]]
name = "stone"
density = 2650
stiffness = "0.2 MN/m"
friction = 0.5
restitution = 0.4

[[grains]]
name = "stones"
shape = "clump"
library = "$repository/inputs/track/cyclic/stones.toml"
material = "stone"
count = 100
size = ["40 mm", "50 mm"]
velocity = [0.0, 0.0, -1.0]
fill = { low = [0.0, 0.0, 0.06], high = [0.4, 0.4] }

[[grains]]
name = "marbles"
shape = "sphere"
material = "stone"
count = $count
size = ["14 mm", "20 mm"]
velocity = [0.0, 0.0, -1.0]
fill = { low = [0.0, 0.0, 0.2], high = [0.4, 0.4] }

[[walls]]
kind = "triangles"
material = "stone"
vertices = [[0.0, 0.0, 0.05], [0.4, 0.0, 0.05], [0.4, 0.4, 0.01], [0.0, 0.4, 0.01]]
triangles = [[0, 1, 2], [0, 2, 3]]
velocity = [0.02, 0.0, 0.0]

EOF
    plane "[0, 0, 0]" "[0, 0, 1]"
    plane "[0, 0, 0]" "[1, 0, 0]"
    plane "[0.4, 0, 0]" "[-1, 0, 0]"
    plane "[0, 0, 0]" "[0, 1, 0]"
    plane "[0, 0.4, 0]" "[0, -1, 0]"
    printf '[time]\nend = "0.15 s"\n\n[output]\nframes = 3\ncheckpoint = 1\n'
} >scene.toml

# Without files that contain times.
same() { diff -r -x summary.json -x log.txt -x run.json "$1" "$2" >differences || fail "$1 and $2 differ: $(head -3 differences)"; }

"$trackbed" run scene.toml --out alone --quiet --threads 1
for n in ${RANKS-1 2 3 4}; do
    ranks "$n" "$trackbed" run scene.toml --out "ranks_$n" --quiet 2>"said_$n" || fail "$n ranks: $(cat "said_$n")"
    same alone "ranks_$n"
    echo "$n ranks: the same $(find "ranks_$n" -type f | wc -l) files as without MPI, the state at the end included"
done

# Process of a rank by its results directory.
process() {
    for p in $(pgrep -f -- "--out $1\b"); do
        tr '\0' '\n' <"/proc/$p/environ" 2>/dev/null | grep -qx "OMPI_COMM_WORLD_RANK=$2" && echo "$p"
    done
    true
}

for victim in 2 0; do
    out=killed_$victim
    ranks 4 "$trackbed" run scene.toml --out "$out" 2>"said_$out" >/dev/null &
    started=$!
    for _ in $(seq 600); do [ -e "$out/checkpoint/a.checkpoint" ] && break; sleep 0.1; done
    [ -e "$out/checkpoint/a.checkpoint" ] || fail "no checkpoint"
    sleep 0.3
    kill -9 "$(process "$out" "$victim")"
    code=0
    wait "$started" || code=$?
    [ "$code" != 0 ] || fail "exit code 0 after rank $victim was killed"
    pgrep -f -- "--out $out\b" && fail "a rank is left"
    said=$(grep -c "rank $victim is lost" "said_$out" || true)
    [ "$said" = 1 ] || fail "rank $victim was killed; said $said times so: $(cat "said_$out")"
    echo "rank $victim killed: exit code $code; $(grep "rank $victim is lost" "said_$out")"
    ranks 3 "$trackbed" run scene.toml --out "$out" --resume --quiet 2>"said_$out" || fail "resumed: $(cat "said_$out")"
    same alone "$out"
    echo "gone on with 3 ranks from its last checkpoint: the same files"
done
rm -r "$folder"

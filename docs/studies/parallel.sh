#!/bin/sh
# A study in eight parts by GNU parallel, here or with `--sshlogin` on machines that share the folder:
#
#   sh docs/studies/parallel.sh inputs/studies/ballast.toml results/ballast
set -eu
seq 8 | parallel trackbed study "$1" --out "$2" --task {}/8 --jobs 1 --threads 1 --resume
trackbed study "$1" --out "$2" --merge

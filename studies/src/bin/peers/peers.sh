#!/bin/sh
# Solves the problems of the studies `peers`, `yielding` and `stress` with other programs and writes `peers.csv`,
# `waves.csv`, `hardness.csv` and `stress.csv`:
#
#     studies/src/bin/peers/peers.sh [DIR]
#
# from the root of the repository, with everything that is made on the way in DIR, out/peers unless given. Needs Python
# 3.11 with venv, a C++ compiler, and Eigen's headers in /usr/include/eigen3 (Debian: libeigen3-dev), which aspher is
# built with.
set -e
dir=${1:-out/peers}
here=studies/src/bin/peers
cargo build --release -p asperity-cli
cargo run --release -p asperity-studies --bin peers -- --write "$dir"
if [ ! -x "$dir/venv/bin/python" ]; then
    python3 -m venv "$dir/venv"
fi
"$dir/venv/bin/pip" install --quiet --requirement "$here/requirements.txt" \
    --config-settings=cmake.define.FETCHCONTENT_SOURCE_DIR_EIGEN3_SRC=/usr/include/eigen3
"$dir/venv/bin/python" "$here/hardness.py" target/release/asperity "$here/hardness.csv"
"$dir/venv/bin/python" "$here/stress.py" "$here/stress.csv"
"$dir/venv/bin/python" "$here/peers.py" "$dir" "$here/peers.csv" "$here/waves.csv"

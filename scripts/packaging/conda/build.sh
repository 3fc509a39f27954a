#!/bin/sh
set -eu
# shellcheck disable=SC2086  # CMAKE_ARGS are meant to be split
cmake -S . -B build-conda -G Ninja ${CMAKE_ARGS:-} -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX="$PREFIX" \
  -DCMAKE_PREFIX_PATH="$PREFIX" -DPOLAR_TESTS=OFF -DPOLAR_BENCHMARKS=OFF
cmake --build build-conda
cmake --install build-conda

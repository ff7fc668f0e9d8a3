#!/usr/bin/env bash
# libFuzzer on the scene parser, under ASan and UBSan: first it must find a bug that is put in, then it
# must find none and reach nine tenths of the parser's lines.
#
#   tests/parser/run.sh [SECONDS]      how long to look for bugs; 60 unless given
set -euo pipefail
cd "$(dirname "$0")/../.."

seconds=${1-60}
folder=build-fuzz
compiler=clang++-14
flags=(-std=c++20 -O1 -g -I. -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=undefined
  -fprofile-instr-generate -fcoverage-mapping)
sources=(engine/scene/*.cpp)
# What the parser takes from its neighbours comes as it is.
rest=(build/libengine.a $(pkg-config --libs vulkan libturbojpeg libisal libpng OpenEXR spdlog))
# A vector that only one side watches over looks overrun to it.
export ASAN_OPTIONS=detect_container_overflow=0

./cyanometer build
mkdir -p "$folder/corpus"
for source in "${sources[@]}"; do
  object=$folder/$(basename "$source").o
  if [[ $object -ot $source ]]; then echo "$compiler ${flags[*]} -c $source -o $object"; fi
done | xargs -r -d '\n' -P "$(nproc)" -n 1 sh -c

target() { # target NAME FLAG...
  local name=$1
  shift
  "$compiler" "${flags[@]}" -fsanitize=fuzzer "$@" -x c++ tests/parser/scene_fuzzer.cc -x none \
    "$folder"/*.o "${rest[@]}" -o "$folder/$name"
}

fuzz() { # fuzz NAME ARGUMENT...
  local name=$1
  shift
  LLVM_PROFILE_FILE=$folder/$name.profraw "$folder/$name" -timeout=10 -rss_limit_mb=2048 \
    -max_len=16384 -verbosity=0 -print_final_stats=1 -artifact_prefix="$folder/" "$@"
}

target seeded -DSEEDED_BUG
if fuzz seeded -max_total_time=60 2>"$folder/seeded.log"; then
  echo "the seeded bug was not found"
  exit 1
fi
grep -q 'broken: the seeded bug' "$folder/seeded.log"
echo "the seeded bug was found"

target fuzzer
fuzz fuzzer -max_total_time="$seconds" "$folder/corpus" 2>&1 | grep -E 'stat::|broken|ERROR|SUMMARY'
llvm-profdata-14 merge -sparse "$folder/fuzzer.profraw" -o "$folder/fuzzer.profdata"
lines=$(llvm-cov-14 report "$folder/fuzzer" -instr-profile="$folder/fuzzer.profdata" engine/scene |
  awk '/^TOTAL/ {print $10}')
echo "lines of the parser that were reached: $lines"
awk -v lines="${lines%\%}" 'BEGIN {exit !(lines >= 90)}'

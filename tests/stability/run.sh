#!/usr/bin/env bash
# Every row of the stability suite at its hardest, and random scenes; a quarter of an hour of two cores.
set -euo pipefail

./cyanometer build

# A process a core, since compiling kernels keeps one core busy; then what has a thread a core itself.
on_all_cores='RandomScenes.*'
shards=$(nproc)
processes=()
for ((shard = 0; shard < shards; ++shard)); do
  GTEST_TOTAL_SHARDS=$shards GTEST_SHARD_INDEX=$shard \
    build/test_stability --gtest_brief=1 --gtest_filter="-$on_all_cores" &
  processes+=($!)
done
failed=0
for process in "${processes[@]}"; do wait "$process" || failed=1; done
build/test_stability --gtest_brief=1 --gtest_filter="$on_all_cores" || failed=1
exit "$failed"

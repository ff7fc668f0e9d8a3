#!/usr/bin/env bash
# What a running daemon bears: more requests than it can do, thousands of connections that do nothing,
# being stopped in the middle, a hundred thousand frames. Some twenty minutes on two cores; alone, or the
# times that are measured are those of something else. By name:
#
#   build/test_abuse --gtest_filter=Abuse.OverloadWithFramesOf720p
set -euo pipefail

./cyanometer build
ulimit -n "$(ulimit -H -n)"
build/test_abuse

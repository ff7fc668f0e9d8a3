#!/usr/bin/env bash
# The compiled suites once more under Vulkan's validation layer and its synchronization checks. The layer
# only prints. What it says is taken from a pipe of its own: what the programs that suites start write to
# standard error, nobody may read.
set -euo pipefail

./cyanometer build
export CYANOMETER_VALIDATION=1
folder=$PWD/build/validation
said=$folder/said
export VK_LAYER_SETTINGS_PATH=$folder
rm -rf "$folder"
mkdir "$folder"
# Not a file: each process would begin it anew.
mkfifo "$folder/pipe"
cat >"$folder/vk_layer_settings.txt" <<END
khronos_validation.debug_action = VK_DBG_LAYER_ACTION_LOG_MSG
khronos_validation.report_flags = error,warn
khronos_validation.log_filename = $folder/pipe
END

# under_the_layer COMMAND...: leaves in $said what the layer said of all of its processes.
under_the_layer() {
  cat "$folder/pipe" >"$said" &
  exec 9>"$folder/pipe" # it stays open while they come and go
  "$@" 9>&-
  exec 9>&-
  wait
}
objections() { grep -E 'VUID-|SYNC-HAZARD-|UNASSIGNED-' "$said"; }

# First that a call which is wrong on purpose is seen, of a process whose own output goes elsewhere.
wrong_call() { build/test_validation >"$folder/wrong_call" 2>&1; }
under_the_layer wrong_call
if ! objections >/dev/null; then
  echo "what the validation layer objects to is not seen"
  exit 1
fi

# Random scenes and those that break methods go the ways of the other suites' for hours.
under_the_layer ctest --test-dir build --output-on-failure --no-tests=error -LE '^(further|stability)$'
if objections; then
  echo "the validation layer objects"
  exit 1
fi
echo "the validation layer has no objection"

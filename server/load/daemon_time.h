// The processor's time that a daemon has taken.
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>

namespace cyanometer {

/// Of a process of this machine, s. None where there is no such process.
std::optional<double> process_seconds(pid_t process);

/// The value of a metric without labels in Prometheus' text format.
std::optional<double> metric_of(const std::string& text, const std::string& name);

}  // namespace cyanometer

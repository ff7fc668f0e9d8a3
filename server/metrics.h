// Counters and histograms in Prometheus' text format.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace cyanometer {

class Metrics {
 public:
  void answered(const std::string& route, const std::string& method, int status,
                double seconds);
  /// One stage of a rendered answer: "queue", "prepare", "render", "encode".
  void stage(const std::string& name, double seconds);

  /// All that was counted here.
  std::string text() const;

  /// One value that is known elsewhere, with its HELP and TYPE lines.
  static std::string value(const std::string& name, const std::string& type,
                           const std::string& help, double value,
                           const std::string& labels = "");

 private:
  struct Histogram {
    std::vector<std::uint64_t> buckets;
    double sum = 0;
    std::uint64_t count = 0;
    void add(double seconds);
    std::string text(const std::string& name, const std::string& label) const;
  };
  mutable std::mutex mutex_;
  std::map<std::string, std::uint64_t> answers_;  ///< by labels
  std::map<std::string, Histogram> durations_, stages_;
};

}  // namespace cyanometer

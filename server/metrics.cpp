#include "server/metrics.h"

#include <array>
#include <sstream>

namespace cyanometer {
namespace {

constexpr std::array bounds_s{0.001, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1,  0.25,
                              0.5,   1.0,    2.5,   5.0,  10.0,  30.0, 60.0, 300.0};

std::string number(double value) {
  std::ostringstream out;
  out.precision(15);
  out << value;
  return out.str();
}

std::string preamble(const std::string& name, const std::string& type,
                     const std::string& help) {
  return "# HELP " + name + " " + help + "\n# TYPE " + name + " " + type + "\n";
}

}  // namespace

void Metrics::Histogram::add(double seconds) {
  buckets.resize(bounds_s.size());
  for (std::size_t i = 0; i < bounds_s.size(); ++i) buckets[i] += seconds <= bounds_s[i];
  sum += seconds;
  ++count;
}

std::string Metrics::Histogram::text(const std::string& name, const std::string& label) const {
  std::string out;
  for (std::size_t i = 0; i < bounds_s.size(); ++i) {
    out += name + "_bucket{" + label + ",le=\"" + number(bounds_s[i]) + "\"} " +
           std::to_string(buckets[i]) + "\n";
  }
  out += name + "_bucket{" + label + ",le=\"+Inf\"} " + std::to_string(count) + "\n";
  out += name + "_sum{" + label + "} " + number(sum) + "\n";
  out += name + "_count{" + label + "} " + std::to_string(count) + "\n";
  return out;
}

void Metrics::answered(const std::string& route, const std::string& method, int status,
                       double seconds) {
  const std::lock_guard lock(mutex_);
  ++answers_["route=\"" + route + "\",method=\"" + method + "\",status=\"" +
             std::to_string(status) + "\""];
  durations_["route=\"" + route + "\""].add(seconds);
}

void Metrics::stage(const std::string& name, double seconds) {
  const std::lock_guard lock(mutex_);
  stages_["stage=\"" + name + "\""].add(seconds);
}

std::string Metrics::text() const {
  const std::lock_guard lock(mutex_);
  std::string out = preamble("cyanometer_http_requests_total", "counter", "Requests answered.");
  for (const auto& [labels, count] : answers_) {
    out += "cyanometer_http_requests_total{" + labels + "} " + std::to_string(count) + "\n";
  }
  out += preamble("cyanometer_http_request_duration_seconds", "histogram",
                  "From a request's last byte to its answer.");
  for (const auto& [label, histogram] : durations_) {
    out += histogram.text("cyanometer_http_request_duration_seconds", label);
  }
  out += preamble("cyanometer_stage_duration_seconds", "histogram",
                  "Stages of rendered answers, as in Server-Timing.");
  for (const auto& [label, histogram] : stages_) {
    out += histogram.text("cyanometer_stage_duration_seconds", label);
  }
  return out;
}

std::string Metrics::value(const std::string& name, const std::string& type,
                           const std::string& help, double value, const std::string& labels) {
  const std::string braces = labels.empty() ? "" : "{" + labels + "}";
  return preamble(name, type, help) + name + braces + " " + number(value) + "\n";
}

}  // namespace cyanometer

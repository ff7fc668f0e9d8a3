// GET /healthz, /readyz, /metrics: for those who run the daemon.
#include <nlohmann/json.hpp>

#include "server/http/problem.h"
#include "server/process_use.h"
#include "server/routes/openapi.h"
#include "server/routes/route.h"

namespace cyanometer {
namespace {

using nlohmann::json;

Answer text(std::string body, const std::string& type) {
  Answer answer;
  answer.headers = {{"Content-Type", type}, {"Cache-Control", "no-store"}};
  answer.body = std::move(body);
  return answer;
}

json text_operation(std::initializer_list<int> problems) {
  const json content{{"text/plain", {{"schema", {{"type", "string"}}}}}};
  return {{"responses", openapi::responses(content, problems)}};
}

std::string metrics_of(Service& service) {
  const auto counts = service.queue.counts();
  const auto value = [](const std::string& name, const std::string& type,
                        const std::string& help, auto number) {
    return Metrics::value(name, type, help, static_cast<double>(number));
  };
  std::string out = service.metrics.text();
  out += value("cyanometer_queue_depth", "gauge", "Jobs that wait for the device.",
               service.queue.depth());
  out += value("cyanometer_queue_capacity", "gauge", "Jobs that may wait.",
               service.queue.capacity());
  out += value("cyanometer_device_busy", "gauge", "1 while a job is on the device.",
               service.queue.busy() ? 1 : 0);
  out += value("cyanometer_jobs_total", "counter", "Jobs done on the device.", counts.done);
  out += value("cyanometer_rejected_total", "counter", "Requests refused by a full queue.",
               service.turned_away.load());
  out += value("cyanometer_cancelled_total", "counter", "Jobs whose client left.",
               counts.client_gone);
  out += value("cyanometer_expired_total", "counter", "Jobs past their deadline.",
               counts.past_deadline);
  out += value("cyanometer_device_lost_total", "counter", "Times the device was lost.",
               counts.device_lost);
  out += value("cyanometer_out_of_memory_total", "counter",
               "Jobs that found no memory at first.", counts.out_of_memory);
  out += value("cyanometer_gave_way_total", "counter",
               "Short jobs done between the tiles of long ones.", counts.gave_way);
  const auto frames = service.frames.counts();
  out +=
      value("cyanometer_frames_rendered_total", "counter", "Frames rendered.", frames.rendered);
  out += value("cyanometer_frames_joined_total", "counter",
               "Frames that another request in flight rendered.", frames.joined);
  out += value("cyanometer_frames_kept_total", "counter", "Frames that had been kept.",
               frames.kept);
  out += value("cyanometer_kept_frame_bytes", "gauge", "Memory of kept frames.",
               frames.kept_bytes);
  const auto device = service.queue.device_use();
  out += value("cyanometer_table_bytes", "gauge", "Memory of tables.", device.table_bytes);
  out += value("cyanometer_device_memory_bytes", "gauge", "The device's memory in use.",
               device.bytes);
  out += value("cyanometer_kernels", "gauge", "Compiled kernels that are kept.",
               device.kernels.kept);
  out += value("cyanometer_kernels_capacity", "gauge", "Compiled kernels that may be kept.",
               service.config.kernels);
  out += value("cyanometer_kernels_compiled_total", "counter",
               "Kernels compiled since the device was made.", device.kernels.compiled);
  out += value("cyanometer_connections", "gauge", "Open connections.", service.connections());
  out +=
      value("cyanometer_ready", "gauge", "1 when requests are taken.", service.ready() ? 1 : 0);
  const ProcessUse process = process_use();
  out += value("process_cpu_seconds_total", "counter", "The processor's time, of all threads.",
               process.cpu_s);
  out += value("process_resident_memory_bytes", "gauge", "Memory of the process.",
               process.resident_bytes);
  out += Metrics::value("cyanometer_build_info", "gauge", "The version.", 1,
                        "version=\"" + version() + "\"");
  return out;
}

}  // namespace

Route healthz() {
  return {"GET",
          "/healthz",
          "The process is alive",
          [] { return text_operation({503}); },
          [](const Request&, Service& service) {
            if (service.queue.failed())
              throw HttpProblem(503, "There is no device to work on.");
            return text("ok\n", "text/plain");
          },
          true};
}

Route readyz() {
  return {"GET",
          "/readyz",
          "Requests are taken",
          [] { return text_operation({503}); },
          [](const Request&, Service& service) {
            if (service.draining) throw HttpProblem(503, "The server is stopping.");
            if (!service.ready()) throw HttpProblem(503, "The device is being prepared.");
            return text("ready\n", "text/plain");
          },
          true};
}

Route metrics_text() {
  return {"GET",
          "/metrics",
          "Prometheus metrics",
          [] { return text_operation({}); },
          [](const Request&, Service& service) {
            return text(metrics_of(service), "text/plain; version=0.0.4; charset=utf-8");
          },
          true};
}

}  // namespace cyanometer

#include "server/batch/batch.h"

#include <atomic>
#include <exception>
#include <limits>
#include <mutex>
#include <thread>

#include "engine/fingerprint.h"
#include "engine/scene/document.h"
#include "engine/surface/surface_pass.h"
#include "server/batch/whole_file.h"
#include "server/routes/frame.h"

namespace cyanometer {
namespace {

using nlohmann::json;

std::string key_of(const BatchFrame& frame) {
  return fingerprint(version() + frame.asked.canonical + ground_revision(frame.asked.scene));
}

json line_of(const BatchFrame& frame, const Plan& plan, const EncodedFrame& made,
             const std::string& device) {
  const json scene = json::parse(frame.asked.canonical);
  json line = plan_document(plan);
  line["frame"] = frame.number;
  line["file"] = frame.file.filename().string();
  line["bytes"] = made.bytes.size();
  line["key"] = key_of(frame);
  line["patch"] = frame.patch;
  line["camera"] = scene.at("camera");
  line["sun"] = scene.at("sun");
  line["met"] = plan.met;
  line["exposure_ev"] = made.exposure_ev;
  line["render_ms"] = made.render_ms;
  line["prepare_ms"] = made.prepare_ms;
  line["version"] = version();
  line["device"] = device;
  return line;
}

Config config_of(const Batch& batch) {
  Config config;
  config.device = batch.device;
  config.queue = 8 * batch.workers;  // nobody is ever turned away
  config.max_device_s = std::numeric_limits<double>::infinity();
  config.warm = false;
  return config;
}

class Run {
 public:
  Run(const Batch& batch, Manifest& manifest, const Watch& watch)
      : batch_(batch), manifest_(manifest), watch_(watch) {}

  BatchProgress run() {
    find_work();
    if (todo_.empty()) return progress_;
    Service service(config_of(batch_));
    std::vector<std::thread> workers;
    for (int i = 0; i < batch_.workers; ++i) workers.emplace_back([&] { work(service); });
    for (auto& worker : workers) worker.join();
    if (failure_) std::rethrow_exception(failure_);
    return progress_;
  }

 private:
  void find_work() {
    std::set<std::string> files;
    for (const int number : batch_.numbers) {
      watch_.check();
      const BatchFrame frame = batch_.frame(number);
      ++progress_.frames;
      if (manifest_.complete(frame.file, key_of(frame))) {
        ++progress_.there;
      } else {
        todo_.push_back(number);
        files.insert(frame.file.filename().string());
      }
    }
    batch_.show(progress_);
    if (!todo_.empty()) manifest_.begin(files);
  }

  void work(Service& service) {
    try {
      for (;;) {
        const std::size_t i = next_++;
        if (i >= todo_.size()) return;
        make(batch_.frame(todo_[i]), service);
      }
    } catch (...) {
      const std::lock_guard lock(mutex_);
      // The others end as cancelled because of the first.
      if (!failure_) failure_ = std::current_exception();
      failed_ = true;
    }
  }

  void make(const BatchFrame& frame, Service& service) {
    Watch watch = watch_;
    watch.gone = [this] { return failed_ || watch_.gone(); };
    watch.progress = [](double) {};
    watch.check();
    const PlannedFrame planned = plan_frame(frame.asked, "", service, watch);
    watch.progress = [this](double share) { show([&] { progress_.running = share; }); };
    const auto got = get_frame(planned, "", service, watch, false);
    write_whole(frame.file, got.frame->bytes);
    manifest_.add(line_of(frame, planned.plan, *got.frame, service.queue.device().name));
    show([&] {
      ++progress_.rendered;
      progress_.running = 0;
    });
  }

  void show(const std::function<void()>& change) {
    const std::lock_guard lock(mutex_);
    change();
    batch_.show(progress_);
  }

  const Batch& batch_;
  Manifest& manifest_;
  const Watch& watch_;
  std::vector<int> todo_;
  std::atomic<std::size_t> next_{0};
  std::atomic<bool> failed_{false};
  std::mutex mutex_;
  BatchProgress progress_;
  std::exception_ptr failure_;
};

}  // namespace

double BatchProgress::share() const {
  if (frames == 0) return 1;
  return (static_cast<double>(there + rendered) + running) / static_cast<double>(frames);
}

BatchProgress run_batch(const Batch& batch, Manifest& manifest, const Watch& watch) {
  return Run(batch, manifest, watch).run();
}

}  // namespace cyanometer

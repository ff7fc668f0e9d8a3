// POST and GET /v1/stream: frames one after the other in one answer.
#include <atomic>
#include <deque>
#include <future>
#include <nlohmann/json.hpp>

#include "server/current_problem.h"
#include "server/log.h"
#include "server/routes/frame.h"
#include "server/routes/openapi.h"
#include "server/routes/patience.h"
#include "server/routes/route.h"
#include "server/routes/sequence.h"
#include "server/routes/steady_plans.h"

namespace cyanometer {
namespace {

using nlohmann::json;
using Clock = std::chrono::steady_clock;

/// Each part's length is known, so that no part can hold what looks like its end.
const std::string boundary = "frame";

struct Part {
  std::string head;
  Frames::Got frame;
  bool last = false;
};

/// The turn of a frame to be planned and rendered: the next one's comes when it is over, and
/// fails as it failed.
class Turn {
 public:
  ~Turn() { end(); }
  void end() {
    if (!std::exchange(ended_, true)) over_.set_value();
  }
  void fail(const std::exception_ptr& error) {
    if (!std::exchange(ended_, true)) over_.set_exception(error);
  }
  std::shared_future<void> over() { return over_.get_future().share(); }

 private:
  std::promise<void> over_;
  bool ended_ = false;
};

/// While one frame is sent, on the connection's own thread, one is encoded and one rendered: no
/// more, so that a slow reader slows itself alone.
constexpr std::size_t most_ahead = 2;
/// Of frames that are this part of the memory of all, or more, none is made ahead: one that
/// waits for memory that its own reader holds up would stand in the way of others.
constexpr std::size_t large_part = 8;

class Stream {
 public:
  Stream(Request request, Service& service, Sequence sequence)
      : request_(std::move(request)),
        service_(service),
        sequence_(std::move(sequence)),
        plans_(service, request_.peer) {}

  /// Makes the first part, so that what hinders it is answered as everywhere.
  void start(const Watch& watch) {
    if (sequence_.refines) {
      const int last = sequence_.count - 1;
      sequence_.within(last, [&] {
        aim_ = plan_frame(sequence_.scene(last), request_.peer, service_, watch);
        check_memory(aim_->asked.scene, aim_->plan, service_.config);
      });
    }
    first_ = next(watch, [] {});
  }

  void send(const Write& write) {
    const auto begin = Clock::now();
    const bool whole = send_all([&](std::string_view bytes) {
      bytes_ += bytes.size();
      return write(bytes);
    });
    ended_ = true;
    ahead_.clear();
    const double ms = std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
    log_line(spdlog::level::info, {{"event", "stream ended"},
                                   {"id", request_.id},
                                   {"whole", whole},
                                   {"frames", sent_},
                                   {"ms", ms},
                                   {"bytes", bytes_}});
  }

 private:
  bool send_all(const Write& write) {
    if (!write("--" + boundary + "\r\n")) return false;
    Part part = *std::exchange(first_, std::nullopt);
    try {
      for (;;) {
        while (ahead_.size() < most_ahead && may_go_ahead()) begin_next();
        if (!send_part(write, part)) return false;
        if (part.last) return true;
        part.frame = {};  // so that it is not held while the next is waited for
        if (ahead_.empty()) begin_next();
        part = ahead_.front().get();
        ahead_.pop_front();
      }
    } catch (...) {
      ended_ = true;
      send_problem(write, current_problem());
      return false;
    }
  }

  bool may_go_ahead() const {
    if (sequence_.refines || begun_ == sequence_.count) return false;
    return large_part * frame_bytes(sequence_.scene(begun_).scene) <=
           service_.config.frame_bytes();
  }

  void begin_next() {
    ++begun_;
    const auto turn = std::make_shared<Turn>();
    ahead_.push_back(std::async(std::launch::async,
                                [this, turn, before = std::exchange(turn_over_, turn->over())] {
                                  if (before.valid()) before.get();
                                  return make(*turn);
                                }));
  }

  Part make(Turn& turn) try {
    Watch watch = service_.watch(request_);
    watch.gone = [this, left = watch.gone] { return ended_ || left(); };
    const int place = next_;
    Part part = patiently(watch, [&] {
      next_ = place;
      return next(watch, [&turn] { turn.end(); });
    });
    turn.end();  // also where another had rendered it
    return part;
  } catch (...) {
    turn.fail(std::current_exception());
    throw;
  }

  bool send_part(const Write& write, const Part& part) {
    // The boundary follows at once: browsers show a part when they have seen its end.
    const std::string end = "\r\n--" + boundary + (part.last ? "--\r\n" : "\r\n");
    const bool taken = write(part.head) && write(part.frame.frame->bytes) && write(end);
    sent_ += taken;
    return taken;
  }

  /// In place of the frames that are missing; nobody reads it where the client has left.
  void send_problem(const Write& write, const HttpProblem& problem) const {
    const std::string body = problem_json(problem, request_.id);
    write("Content-Type: application/problem+json\r\nContent-Length: " +
          std::to_string(body.size()) + "\r\n\r\n" + body + "\r\n--" + boundary + "--\r\n");
  }

  /// @param rendered  called when another one may be planned and rendered
  Part next(const Watch& watch, const std::function<void()>& rendered) {
    PlannedFrame planned;
    Frames::Got got;
    int number = 0;
    sequence_.within(next_, [&] {
      planned = next_plan(watch);
      check_memory(planned.asked.scene, planned.plan, service_.config);
      shown_ = planned.plan;
      number = next_;
      got = get_frame(planned, request_.peer, service_, watch, number == sequence_.count,
                      rendered);
    });
    Fields fields = planned_fields(planned);
    fields.emplace_back("Content-Length", std::to_string(got.frame->bytes.size()));
    fields.emplace_back("Cyanometer-Frame",
                        std::to_string(number) + "/" + std::to_string(sequence_.count));
    for (auto& field : frame_fields(planned, got, service_)) fields.push_back(std::move(field));
    std::string head;
    for (const auto& [name, value] : fields) head += name + ": " + value + "\r\n";
    return {head + "\r\n", got, number == sequence_.count};
  }

  /// Leaves `next_` behind the frame.
  PlannedFrame next_plan(const Watch& watch) {
    while (sequence_.refines && next_ + 1 < sequence_.count) {
      PlannedFrame coarse =
          plan_frame(sequence_.scene(next_++), request_.peer, service_, watch);
      const bool again =
          coarse.plan.method == shown_.method && coarse.plan.options == shown_.options;
      const bool worth = coarse.plan.expected_ms <= aim_->plan.expected_ms / 2 &&
                         coarse.plan.expected_error > aim_->plan.expected_error;
      if (again || !worth) continue;
      return coarse;
    }
    const int place = next_++;
    return sequence_.refines ? *aim_ : plans_.next(sequence_.scene(place), watch);
  }

  Request request_;
  Service& service_;
  Sequence sequence_;
  SteadyPlans plans_;
  std::optional<PlannedFrame> aim_;  ///< of a refinement
  Plan shown_;                       ///< of the frame before
  std::optional<Part> first_;
  int next_ = 0;  ///< of the frame whose turn it is
  int begun_ = 1;
  std::shared_future<void> turn_over_;  ///< of the frame begun last
  int sent_ = 0;
  std::size_t bytes_ = 0;
  std::atomic<bool> ended_ = false;  ///< nothing more will be sent
  std::deque<std::future<Part>> ahead_;
};

Answer stream(Sequence sequence, const Request& request, Service& service, const Watch& watch) {
  Answer answer;
  answer.headers = {{"Content-Type", "multipart/x-mixed-replace; boundary=" + boundary},
                    {"Cache-Control", "no-store"}};
  if (request.method == "HEAD") {
    answer.length_known = false;
    return answer;
  }
  const auto stream = std::make_shared<Stream>(request, service, std::move(sequence));
  stream->start(watch);
  answer.stream = [stream](const Write& write) { stream->send(write); };
  return answer;
}

json stream_operation() {
  const json content{
      {"multipart/x-mixed-replace", {{"schema", {{"type", "string"}, {"format", "binary"}}}}}};
  json responses = openapi::responses(content, {406, 411, 422, 429, 504});
  responses["200"]["description"] =
      "Frames, each with Cyanometer-Frame (3/120), Cyanometer-Error and what else a rendered "
      "answer says of itself. Where one cannot be made, a part of application/problem+json "
      "ends the stream. Closing the connection cancels the work.";
  return {{"responses", responses}};
}

json body_schema() {
  const json scene = openapi::scene_schema_reference();
  return {{"type", "object"},
          {"properties",
           {{"scene", scene},
            {"frames",
             {{"description",
               "Merge patches of the scene, one a frame; or how many frames it takes to where "
               "`to` goes."},
              {"oneOf",
               {{{"type", "array"}, {"minItems", 1}, {"items", {{"type", "object"}}}},
                {{"type", "integer"}, {"minimum", 1}}}}}},
            {"to",
             {{"type", "object"},
              {"description",
               "Numbers that are reached linearly, by dotted path, as sun.elevation_deg."},
              {"minProperties", 1},
              {"additionalProperties", {{"type", "number"}}}}},
            {"refine",
             {{"const", true}, {"description", "Coarser frames first, then the scene's."}}}}},
          {"oneOf", {{{"required", {"frames"}}}, {{"required", {"refine"}}}}},
          {"additionalProperties", false}};
}

json parameter(const std::string& name, const json& schema, const std::string& description) {
  return {{"name", name}, {"in", "query"}, {"schema", schema}, {"description", description}};
}

}  // namespace

Route stream_post() {
  return {"POST", "/v1/stream", "Frames of a sequence, or a frame ever finer",
          [] {
            json out = stream_operation();
            out["requestBody"] = openapi::json_body(body_schema());
            return out;
          },
          [](const Request& request, Service& service) {
            const Watch watch = service.watch(request);
            service.admission.check(request);
            return stream(sequence_of_body(request, service.config, watch), request, service,
                          watch);
          }};
}

Route stream_link() {
  return {"GET", "/v1/stream", "The same for links and <img>",
          [] {
            json out = stream_operation();
            out["parameters"] = openapi::link_parameters();
            out["parameters"].push_back(
                parameter("frames", {{"type", "integer"}, {"minimum", 1}},
                          "Frames over which each `to.PATH=number`, as "
                          "`to.sun.elevation_deg=-6`, is reached linearly."));
            out["parameters"].push_back(
                parameter("refine", {{"const", true}}, "Coarser frames first."));
            return out;
          },
          [](const Request& request, Service& service) {
            const Watch watch = service.watch(request);
            service.admission.check(request);
            return stream(sequence_of_link(request, service.config, watch), request, service,
                          watch);
          }};
}

}  // namespace cyanometer

// How wrong the frames are that are timed: each is asked for as it is timed and held against
// the converged solution by the daemon's own /v1/compare.
#include <httplib.h>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <tuple>

#include "engine/scene/document.h"
#include "server/load/survey.h"
#include "server/load/variation.h"

namespace cyanometer {
namespace {

using nlohmann::json;

/// Of a motion, the frame that is judged: two thirds of the way to the far end.
constexpr std::size_t judged_frame = 101;

std::string percent_encoded(const std::string& text) {
  static constexpr char digits[] = "0123456789ABCDEF";
  std::string out;
  for (const char c : text) {
    if (std::isalnum(static_cast<unsigned char>(c)) || std::strchr("-_.~:,", c)) {
      out += c;
    } else {
      out += {'%', digits[static_cast<unsigned char>(c) >> 4], digits[c & 15]};
    }
  }
  return out;
}

/// The document as a link says it.
std::string link_query(const json& document) {
  std::string query;
  for (const auto& [name, value] : document.items()) {
    query += (query.empty() ? "" : "&") + name + "=" + percent_encoded(value.dump());
  }
  return query;
}

void check_answer(const httplib::Result& answer) {
  if (!answer) throw std::runtime_error("no answer: " + httplib::to_string(answer.error()));
  if (answer->status != 200) throw std::runtime_error(answer->body);
}

json judged_scene(const SurveySettings& settings, const SurveyError& of) {
  json scene = settings.scene;
  if (!of.preset.empty()) {
    scene = {{"preset", of.preset}};
    if (settings.scene.contains("method")) scene["method"] = settings.scene.at("method");
  }
  const json image{{"width", of.width}, {"height", of.height}, {"format", "exr"}};
  return Motion(merge(scene, {{"image", image}}), variation_of(of.vary)).frame(judged_frame);
}

class ErrorSurvey {
 public:
  ErrorSurvey(const std::string& origin, const SurveySettings& settings, Survey& survey)
      : settings_(settings), survey_(survey), client_(origin) {
    client_.set_keep_alive(true);
    client_.set_tcp_nodelay(true);
    client_.set_read_timeout(600);
  }

  /// The frame's error, measured or that of another size of the same frame by the same means.
  void measure(SurveyError& error) {
    const json scene = judged_scene(settings_, error);
    const httplib::Result answer = client_.Post("/v1/render", scene.dump(), "application/json");
    check_answer(answer);
    const auto field = [&](const char* name) { return answer->get_header_value(name); };
    error.method = field("Cyanometer-Method") + " " + field("Cyanometer-Options");
    error.stated = std::stod(field("Cyanometer-Error"));
    const auto same = std::ranges::find_if(survey_.errors, [&](const SurveyError& known) {
      return known.preset == error.preset && known.vary == error.vary &&
             known.method == error.method;
    });
    if (same == survey_.errors.end()) {
      judge(scene, answer->body, error);
    } else {
      error.error = same->error, error.low = same->low, error.high = same->high;
    }
  }

 private:
  void judge(const json& scene, const std::string& picture, SurveyError& error) {
    const httplib::Result answer =
        client_.Post("/v1/compare?" + link_query(scene), picture, "image/x-exr");
    check_answer(answer);
    const json figures = json::parse(answer->body);
    const double found = figures.at("error");
    const json interval = figures.value("error_95", json{found, found});
    error.error = found, error.low = interval.at(0), error.high = interval.at(1);
  }

  const SurveySettings& settings_;
  Survey& survey_;
  httplib::Client client_;
};

auto frame_of(const SurveyError& error) {
  return std::tie(error.preset, error.vary, error.width, error.height);
}

}  // namespace

std::vector<SurveyError> missing_errors(const SurveySettings& settings, const Survey& survey) {
  std::vector<std::string> presets{""};
  presets.insert(presets.end(), settings.presets.begin(), settings.presets.end());
  std::vector<SurveyError> missing;
  for (const std::string& preset : presets) {
    for (const std::string& vary : settings.vary) {
      for (const auto& [width, height] : settings.sizes) {
        missing.push_back({preset, vary, width, height});
      }
    }
  }
  std::erase_if(missing, [&](const SurveyError& wanted) {
    return std::ranges::any_of(survey.errors, [&](const SurveyError& known) {
      return frame_of(known) == frame_of(wanted);
    });
  });
  return missing;
}

void measure_errors(const SurveyedDaemon& daemon, const SurveySettings& settings,
                    const Watch& watch, const std::function<void(const SurveyError&)>& done,
                    Survey& survey) {
  ErrorSurvey errors(daemon.origin, settings, survey);
  for (SurveyError& error : missing_errors(settings, survey)) {
    watch.check();
    errors.measure(error);
    survey.errors.push_back(error);
    done(survey.errors.back());
  }
}

}  // namespace cyanometer

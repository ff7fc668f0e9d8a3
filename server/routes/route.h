// A route: one entry of the table from which requests are answered and the OpenAPI document is
// made.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "server/http/message.h"
#include "server/service.h"

namespace cyanometer {

struct Route {
  std::string method;  ///< GET answers HEAD too
  std::string path;
  std::string summary;
  /// The rest of its OpenAPI operation: parameters, requestBody, responses.
  std::function<nlohmann::json()> operation;
  /// @throws HttpProblem, SceneError, OverLimit, Cancelled, QueueFull, DeviceUnavailable
  std::function<Answer(const Request&, Service&)> answer;
  bool ops = false;  ///< also on the listener for operators
};

/// All routes there are.
const std::vector<Route>& routes();

// One function a route; each is one line in the table of routes.cpp.
Route render_post();
Route render_link();
Route stream_post();
Route stream_link();
Route radiance_post();
Route plan_post();
Route plan_link();
Route compare_post();
Route composite_post();
Route explain_post();
Route attribute_post();
Route chart_post();
Route optics_post();
Route day_post();
Route methods_list();
Route presets_list();
Route limits_list();
Route schema_document();
Route openapi_document();
Route healthz();
Route readyz();
Route metrics_text();
Route page();

}  // namespace cyanometer

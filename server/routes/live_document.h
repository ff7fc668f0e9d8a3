// A document that takes long: at once, or after lines that say how far it is.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "server/routes/route.h"

namespace cyanometer {

/// What the device is to do for the scene.
using SceneWork =
    std::function<nlohmann::json(Engine& engine, const Scene& scene, const Watch& watch)>;

/// Reads the scene, and answers with the document that is made of it; to who accepts
/// application/x-ndjson with lines {"progress": share} and {"progress": 1, `member`: document}
/// or a problem. Closing the connection cancels the work.
/// @throws as routes that take scenes do; HttpProblem 406
Answer live_document(const Request& request, Service& service, const std::string& member,
                     SceneWork work);

/// Of the OpenAPI document. @param answer  schema of the document
nlohmann::json live_document_operation(const std::string& member, const nlohmann::json& answer);

}  // namespace cyanometer

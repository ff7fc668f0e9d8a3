// Pieces of OpenAPI 3.1 operations, shared by the routes.
#pragma once

#include <initializer_list>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace cyanometer::openapi {

/// A requestBody of JSON with this schema.
nlohmann::json json_body(const nlohmann::json& schema);
/// "#/components/schemas/Scene".
nlohmann::json scene_schema_reference();
/// The parameters of a link: any dotted path of a scene.
nlohmann::json link_parameters();
/// Responses: 200 with these media types, and problems of these statuses beside those that any
/// request may be answered.
nlohmann::json responses(const nlohmann::json& content, std::initializer_list<int> problems);
nlohmann::json json_content(const nlohmann::json& schema);
/// Adds a response header to the 200 answer.
void add_header(nlohmann::json& operation_responses, const std::string& name,
                const std::string& description);

/// The whole document, from the table of routes.
nlohmann::json document();

}  // namespace cyanometer::openapi

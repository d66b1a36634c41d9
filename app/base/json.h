// JSON to text and back. The library's parser and writer are large: compiled here, once.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace app {

using Json = nlohmann::ordered_json;

// On one line, or indented by so many spaces a level. Bytes that are not UTF-8 are replaced;
// `ascii`: what is not ASCII is escaped.
std::string jsonText(const Json& json, int indent = -1, bool ascii = false);

// Throws Json::parse_error.
Json parseJson(const std::string& text);

// Json::is_discarded() where the text is no JSON.
Json tryParseJson(const std::string& text);

}  // namespace app

#include "app/base/json.h"

namespace app {

std::string jsonText(const Json& json, int indent, bool ascii) {
  return json.dump(indent, ' ', ascii, Json::error_handler_t::replace);
}

Json parseJson(const std::string& text) { return Json::parse(text); }
Json tryParseJson(const std::string& text) { return Json::parse(text, nullptr, false); }

}  // namespace app

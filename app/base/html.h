// The look that all pages share, and text made safe for them.
#pragma once

#include <string>

namespace app {

std::string escapeHtml(const std::string& text);

// A whole page, with the style inside: no other file, no script.
std::string htmlPage(const std::string& title, const std::string& body);

}  // namespace app

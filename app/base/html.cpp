// The look that all pages share, and text made safe for them.
#include "app/base/html.h"

namespace app {

namespace {

constexpr const char* kStyle = R"(
:root { color-scheme: light dark; --ink: #1c2024; --quiet: #60676e; --line: #dfe3e6; --paper: #fcfcfb;
  --card: #ffffff; --good: #1a7f4b; --bad: #b3261e; }
@media (prefers-color-scheme: dark) { :root { --ink: #e8eaec; --quiet: #9aa2a9; --line: #33383d;
  --paper: #16181a; --card: #1e2124; --good: #57c28a; --bad: #ff8a80; } }
* { box-sizing: border-box; }
body { margin: 0 auto; padding: 2.5rem 1.25rem 4rem; max-width: 76rem; background: var(--paper); color: var(--ink);
  font: 16px/1.55 system-ui, "Segoe UI", "Liberation Sans", sans-serif; }
h1 { font-size: 1.75rem; line-height: 1.2; margin: 0 0 .4rem; }
h2 { font-size: 1.2rem; margin: 0 0 .3rem; }
p { margin: 0 0 .8rem; max-width: 46rem; }
.quiet { color: var(--quiet); }
section { background: var(--card); border: 1px solid var(--line); border-radius: 8px; padding: 1.2rem;
  margin: 1.5rem 0; }
video, .poster { width: 100%; height: auto; border-radius: 4px; background: #fff; display: block; }
.sides { display: grid; grid-template-columns: minmax(0, 3fr) minmax(0, 2fr); gap: 1.5rem; }
.three { display: grid; grid-template-columns: repeat(3, minmax(0, 1fr)); gap: .8rem; }
.three img { width: 100%; border: 1px solid var(--line); image-rendering: pixelated; }
.shots { display: grid; grid-template-columns: repeat(auto-fit, minmax(14rem, 1fr)); gap: .8rem; margin: 0 0 1rem; }
summary { cursor: pointer; color: var(--quiet); } details table { font-size: .8rem; } details { overflow-x: auto; }
figure { margin: 0; } figcaption { color: var(--quiet); font-size: .85rem; }
@media (max-width: 56rem) { .sides, .three { grid-template-columns: 1fr; } }
@media (max-width: 40rem) { body { padding: 1.2rem .7rem 3rem; } section { padding: .8rem; }
  table { display: block; overflow-x: auto; } }
table { border-collapse: collapse; width: 100%; font-size: .9rem; margin: 0 0 1rem; }
th, td { text-align: left; padding: .3rem .6rem .3rem 0; border-bottom: 1px solid var(--line);
  vertical-align: top; }
th { font-weight: 600; color: var(--quiet); }
td.number { font-variant-numeric: tabular-nums; text-align: right; white-space: nowrap; }
.good { color: var(--good); font-weight: 600; } .bad { color: var(--bad); font-weight: 600; }
code { font: .85em ui-monospace, "DejaVu Sans Mono", monospace; overflow-wrap: anywhere; }
)";

}  // namespace

std::string escapeHtml(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

std::string htmlPage(const std::string& title, const std::string& body) {
  return "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
         escapeHtml(title) + "</title>\n<style>" + kStyle + "</style>\n</head>\n<body>\n" + body +
         "</body>\n</html>\n";
}

}  // namespace app

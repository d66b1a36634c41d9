// Results as JUnit's XML.
#include "app/base/junit.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/base/html.h"
#include "app/base/output_file.h"

namespace app {

void writeJunit(const std::string& file, const std::string& title,
                const std::vector<JunitCase>& cases) {
  if (file.empty()) return;
  const auto failed = std::count_if(cases.begin(), cases.end(),
                                    [](const JunitCase& one) { return !one.failure.empty(); });
  std::string text = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n"
      "<testsuite name=\"{}\" tests=\"{}\" failures=\"{}\" errors=\"0\" skipped=\"0\">\n",
      escapeHtml(title), cases.size(), failed);
  for (const JunitCase& one : cases) {
    text += fmt::format("<testcase classname=\"{}\" name=\"{}\">", escapeHtml(one.suite),
                        escapeHtml(one.name));
    if (!one.failure.empty()) {
      text += fmt::format("<failure message=\"{}\"/>", escapeHtml(one.failure));
    }
    if (!one.output.empty()) {
      text += fmt::format("<system-out>{}</system-out>", escapeHtml(one.output));
    }
    text += "</testcase>\n";
  }
  writeFile(file, text + "</testsuite>\n</testsuites>\n");
}

}  // namespace app

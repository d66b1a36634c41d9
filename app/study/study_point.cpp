// Points to and from rows of a table.
#include "app/study/study_point.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <span>
#include <sstream>

#include "app/base/output_file.h"
#include "app/commands/exit_code.h"

namespace app {

namespace {

constexpr const char* kStatusNames[] = {"ok",       "not finite", "exploded",
                                        "too slow", "refused",    "skipped"};

// The one list of columns: `v(head, member)` for each.
template <class V, class P>
void columns(V& v, P& p) {
  v("case", p.key.study);
  v("method", p.key.method);
  v("h", p.h);
  v("steps", p.key.steps);
  v("substeps", p.key.substeps);
  v("iterations", p.key.iterations);
  v("status", p.status);
  v("error", p.errors.error);
  v("last_error", p.errors.last);
  v("compared", p.errors.compared);
  v("residual_m", p.worst.residual);
  v("residual_rad", p.worst.residualAngle);
  v("overlap_m", p.worst.overlap);
  v("energy_drift", p.worst.energyDrift);
  v("momentum_drift", p.worst.momentumDrift);
  v("angular_momentum_drift", p.worst.angularMomentumDrift);
  v("evaluations", p.evaluations);
  v("sweeps", p.sweeps);
  v("restarts", p.restarts);
  v("fallbacks", p.fallbacks);
  v("wall", p.wall);
  v("wall_median", p.wallMedian);
  v("wall_spread", p.wallSpread);
  v("processor", p.processor);
  v("repeats", p.repeats);
  v("load", p.load);
  v("inputs", p.inputs);
  v("message", p.message);
  v("accuracy", p.key.accuracy);
  v("estimate", p.estimate);
}

struct Heads {
  std::string text;
  template <class T>
  void operator()(const char* head, const T&) {
    text += fmt::format("{}{}", text.empty() ? "" : ",", head);
  }
};

struct Writer {
  std::string row;
  void add(const std::string& cell) { row += (row.empty() ? "" : ",") + cell; }
  void operator()(const char*, const std::string& text) {
    std::string cell = text;
    std::replace(cell.begin(), cell.end(), ',', ';');
    std::replace_if(
        cell.begin(), cell.end(), [](unsigned char c) { return c < ' '; }, ' ');
    add(cell);
  }
  void operator()(const char*, int number) { add(fmt::format("{}", number)); }
  void operator()(const char*, double number) { add(fmt::format("{:.9g}", number)); }
  void operator()(const char*, StudyPoint::Status status) { add(statusName(status)); }
};

struct Reader {
  std::span<const std::string> cells;
  bool good = true;

  const std::string& next() {
    const std::string& cell = cells.front();
    cells = cells.subspan(1);
    return cell;
  }
  double number() {
    const std::string& cell = next();
    char* end = nullptr;
    const double value = std::strtod(cell.c_str(), &end);
    good = good && !cell.empty() && *end == '\0';
    return value;
  }
  void operator()(const char*, std::string& text) { text = next(); }
  void operator()(const char*, int& value) { value = static_cast<int>(number()); }
  void operator()(const char*, double& value) { value = number(); }
  void operator()(const char*, StudyPoint::Status& status) {
    const std::string& word = next();
    const auto found = std::find(std::begin(kStatusNames), std::end(kStatusNames), word);
    good = good && found != std::end(kStatusNames);
    if (good) status = static_cast<StudyPoint::Status>(found - std::begin(kStatusNames));
  }
};

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == at) {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

}  // namespace

double StudyKey::work() const {
  return static_cast<double>(steps) * substeps * std::max(1, iterations);
}

std::string accuracyText(double accuracy) {
  const int exponent = static_cast<int>(std::floor(std::log10(accuracy) + 1e-9));
  return fmt::format("{:.3g}e{}", accuracy * std::pow(10.0, -exponent), exponent);
}

std::string StudyKey::text() const {
  if (accuracy > 0) return "accuracy " + accuracyText(accuracy);
  std::string text = steps > 1 ? fmt::format("{} x ", steps) : "";
  text += fmt::format("{} substep{}", substeps, substeps == 1 ? "" : "s");
  if (iterations > 0)
    text += fmt::format(", {} iteration{}", iterations, iterations == 1 ? "" : "s");
  return text;
}

double StudyPoint::cost() const { return processor > 0 ? std::min(wall, processor) : wall; }

bool StudyPoint::isFailure() const {
  return status == Status::kNotFinite || status == Status::kExploded || status == Status::kTooSlow;
}

const char* statusName(StudyPoint::Status status) { return kStatusNames[static_cast<int>(status)]; }

std::string pointHeads() {
  Heads heads;
  const StudyPoint point;
  columns(heads, point);
  return heads.text + "\n";
}

std::string pointRow(const StudyPoint& point) {
  Writer writer;
  columns(writer, point);
  return writer.row + "\n";
}

std::vector<StudyPoint> parsePoints(const std::string& text) {
  std::vector<StudyPoint> points;
  const std::vector<std::string> rows = split(text, '\n');
  const std::string heads = pointHeads();
  if (rows.front() + "\n" != heads) return points;
  const auto width = split(heads, ',').size();
  for (std::size_t i = 1; i + 1 < rows.size(); ++i) {  // the last has no end: nothing, or torn
    const std::vector<std::string> cells = split(rows[i], ',');
    if (cells.size() != width) continue;
    Reader reader{cells};
    StudyPoint point;
    columns(reader, point);
    if (reader.good) points.push_back(std::move(point));
  }
  return points;
}

PointStore::PointStore(std::filesystem::path path, bool keep) : path_(std::move(path)) {
  if (keep) {
    std::ifstream in(path_, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    earlier_ = parsePoints(text.str());
  }
  rewrite(earlier_);
}

const StudyPoint* PointStore::find(const StudyKey& key, const std::string& inputs) const {
  for (const StudyPoint& point : earlier_) {
    const bool isMeasured = point.status != StudyPoint::Status::kSkipped;
    if (isMeasured && point.key == key && point.inputs == inputs) return &point;
  }
  return nullptr;
}

void PointStore::append(const StudyPoint& point) {
  const std::string row = pointRow(point);
  std::FILE* file = std::fopen(path_.c_str(), "ab");
  const bool written =
      file != nullptr && std::fwrite(row.data(), 1, row.size(), file) == row.size();
  const bool closed = file != nullptr && std::fclose(file) == 0;
  if (!written || !closed) throw EnvironmentError("cannot write to " + path_.string());
}

void PointStore::rewrite(const std::vector<StudyPoint>& points) {
  std::string text = pointHeads();
  for (const StudyPoint& point : points) text += pointRow(point);
  writeFile(path_, text);
}

}  // namespace app

// Recording, the truth, and the distance between the two.
#include "scenes/study/study_trace.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scenes/read/reference_table.h"

namespace scenes {
namespace {

using Over = StudyQuantity::Over;

double metricOf(const char* name, const Sample& sample) {
  return std::abs(findMetric(name)->scene(sample));
}

// NaN counts as the worst, and stays.
void keepLargest(double value, double& largest) {
  if (!(value <= largest) && !std::isnan(largest)) largest = value;
}

// Whether a sample counts for a quantity.
bool counts(const StudyCase& study, const StudyQuantity& quantity, int sample) {
  constexpr double kSlack = 1e-9;  // s
  const double time = static_cast<double>(sample) / study.fps;
  const bool trusted =
      quantity.over != Over::kEach || !study.trustedUntil || time <= *study.trustedUntil + kSlack;
  return trusted && time >= quantity.from.value_or(0) - kSlack &&
         time <= quantity.to.value_or(time) + kSlack;
}

double evaluate(const std::vector<double>& law, double t) {
  double value = 0;
  for (std::size_t i = law.size(); i-- > 0;) value = value * t + law[i];
  return value;
}

// A row's cells as the quantity wants them; empty where one is missing.
std::vector<double> cellsOf(const StudyQuantity& quantity, const ReferenceTable& table, int row) {
  std::vector<double> values;
  for (const std::string& word : quantity.columns) {
    const bool minus = word.starts_with('-');
    const int column = table.column(minus ? word.substr(1) : word);
    const double cell = table.rows[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)];
    if (!std::isfinite(cell)) return {};
    values.push_back(quantity.times * (minus ? -cell : cell) + quantity.plus);
  }
  return values;
}

// The rows that the case's `where` chooses.
ReferenceTable chosenRows(const StudyReference& reference) {
  ReferenceTable table = parseReferenceTable(reference.text, reference.table);
  for (const auto& [column, value] : reference.where) {
    const auto k = static_cast<std::size_t>(table.column(column));
    std::erase_if(table.rows, [&, wanted = value](const std::vector<double>& row) {
      return !(std::abs(row[k] - wanted) <= 1e-9 * std::max(1.0, std::abs(wanted)));
    });
  }
  return table;
}

QuantitySamples tableSamples(const StudyCase& study, const StudyQuantity& quantity,
                             const ReferenceTable& table) {
  QuantitySamples samples(static_cast<std::size_t>(study.sampleCount()));
  for (int k = 0; k < study.sampleCount(); ++k) {
    const double time = static_cast<double>(k) / study.fps;
    const int row = rowAt(table, table.column(study.reference.time), time);
    if (row >= 0) samples[static_cast<std::size_t>(k)] = cellsOf(quantity, table, row);
  }
  return samples;
}

QuantitySamples lawSamples(const StudyCase& study, const StudyQuantity& quantity) {
  QuantitySamples samples;
  const auto components = static_cast<std::size_t>(componentsOf(quantity));
  for (int k = 0; k < study.sampleCount(); ++k) {
    const double value = evaluate(quantity.law, static_cast<double>(k) / study.fps);
    samples.emplace_back(components, quantity.times * value + quantity.plus);
  }
  return samples;
}

// The largest of the bodies' errors, or their root mean square where the case takes means.
double errorAt(const StudyCase& study, const StudyQuantity& quantity,
               const std::vector<double>& values, const std::vector<double>& truth) {
  const auto n = static_cast<std::size_t>(componentsOf(quantity));
  double largest = 0, sum = 0;
  for (std::size_t i = 0; i < values.size(); i += n) {
    const double* other = truth.data() + (truth.size() == n ? 0 : i);
    const double error = distance(quantity, values.data() + i, other);
    keepLargest(error, largest);
    sum += error * error;
  }
  const bool isLargest =
      study.error == StudyCase::Error::kMax || study.error == StudyCase::Error::kFinal;
  const double count = static_cast<double>(std::max<std::size_t>(1, values.size() / n));
  return quantity.weight * (isLargest ? largest : std::sqrt(sum / count));
}

// One number per component over the samples that count.
std::vector<double> reduce(const StudyCase& study, const StudyQuantity& quantity,
                           const QuantitySamples& samples) {
  std::vector<double> result;
  int count = 0;
  for (int k = 0; k < static_cast<int>(samples.size()); ++k) {
    const std::vector<double>& values = samples[static_cast<std::size_t>(k)];
    if (values.empty() || !counts(study, quantity, k)) continue;
    const bool first = count++ == 0;
    if (first) result.assign(values.size(), 0);
    for (std::size_t i = 0; i < values.size(); ++i) {
      double& r = result[i];
      const double v = values[i];
      if (quantity.over == Over::kLast || (first && quantity.over != Over::kRms)) {
        r = v;
      } else if (quantity.over == Over::kMax) {
        r = std::max(r, v);
      } else if (quantity.over == Over::kMin) {
        r = std::min(r, v);
      } else {
        r += quantity.over == Over::kRms ? v * v : v;
      }
    }
  }
  if (quantity.over == Over::kMean || quantity.over == Over::kRms) {
    for (double& r : result) r /= std::max(1, count);
  }
  if (quantity.over == Over::kRms) {
    for (double& r : result) r = std::sqrt(r);
  }
  return result;
}

// The norm over the quantities that are compared sample by sample; negative: none is at this one.
double normAt(const StudyCase& study, const StudyTrace& trace, const StudyTrace& truth, int k) {
  double square = -1;
  for (std::size_t q = 0; q < study.quantities.size(); ++q) {
    const StudyQuantity& quantity = study.quantities[q];
    if (quantity.over != Over::kEach || !counts(study, quantity, k)) continue;
    const std::vector<double>& own = trace.quantities[q][static_cast<std::size_t>(k)];
    const std::vector<double>& other = truth.quantities[q][static_cast<std::size_t>(k)];
    if (own.empty() || other.empty()) continue;
    const double error = errorAt(study, quantity, own, other);
    square = std::max(square, 0.0) + error * error;
  }
  return square < 0 ? -1 : std::sqrt(square);
}

// The sum of squares of those that are compared as one number each.
double squareOfNumbers(const StudyCase& study, const StudyTrace& trace, const StudyTrace& truth) {
  double square = 0;
  for (std::size_t q = 0; q < study.quantities.size(); ++q) {
    const StudyQuantity& quantity = study.quantities[q];
    if (quantity.over == Over::kEach) continue;
    const std::vector<double> own = reduce(study, quantity, trace.quantities[q]);
    const std::vector<double> other = reduce(study, quantity, truth.quantities[q]);
    if (own.empty() || other.empty()) continue;
    const double error = errorAt(study, quantity, own, other);
    square += error * error;
  }
  return square;
}

// What the case makes of the errors of its samples.
double reduceErrors(StudyCase::Error how, const std::vector<double>& errors) {
  double largest = 0, sum = 0, squares = 0;
  for (const double error : errors) {
    keepLargest(error, largest);
    sum += error;
    squares += error * error;
  }
  const double count = static_cast<double>(std::max<std::size_t>(1, errors.size()));
  switch (how) {
    case StudyCase::Error::kMax:
      return largest;
    case StudyCase::Error::kRms:
      return std::sqrt(squares / count);
    case StudyCase::Error::kMeanSquare:
      return squares / count;
    case StudyCase::Error::kMean:
      return sum / count;
    case StudyCase::Error::kFinal:
      return errors.empty() ? 0 : errors.back();
  }
  return largest;
}

}  // namespace

StudyTracer::StudyTracer(const StudyCase& study, const Simulation& simulation) : study_(study) {
  trace_.quantities.resize(study.quantities.size());
  for (const StudyQuantity& quantity : study.quantities) {
    bodies_.push_back(quantity.body.empty() ? std::vector<physics::BodyId>()
                                            : matchingBodies(simulation, quantity.body));
  }
}

void StudyTracer::observe(const Simulation& simulation) {
  sampler_.observe(simulation);
  const physics::Bodies& bodies = simulation.world().bodies();
  ++trace_.samples;
  observeWorst(sampler_.sample(simulation, {}));
  for (std::size_t q = 0; q < study_.quantities.size(); ++q) {
    const StudyQuantity& quantity = study_.quantities[q];
    std::vector<double> values;
    if (const VectorMetric* vector = findVectorMetric(quantity.metric)) {
      values.resize(bodies_[q].size() * static_cast<std::size_t>(vector->components));
      double* out = values.data();
      for (const physics::BodyId b : bodies_[q]) {
        vector->read(bodies.pose[b], bodies.velocity[b], out);
        out += vector->components;
      }
    } else {
      const Metric& metric = *findMetric(quantity.metric);
      const Sample sample = sampler_.sample(simulation, bodies_[q]);
      if (metric.scene != nullptr) values.push_back(metric.scene(sample));
      for (const physics::BodyId b : bodies_[q]) {
        if (metric.scene == nullptr) values.push_back(metric.body(sample, b));
      }
    }
    trace_.quantities[q].push_back(std::move(values));
  }
}

void StudyTracer::observeWorst(const Sample& sample) {
  for (const physics::KindError& error : sample.now.errors) {
    if (error.unit == "m") keepLargest(error.largest, worst_.residual);
    if (error.unit == "rad") keepLargest(error.largest, worst_.residualAngle);
  }
  keepLargest(sample.now.overlap, worst_.overlap);
  keepLargest(metricOf("energy_drift", sample), worst_.energyDrift);
  keepLargest(metricOf("momentum_drift", sample), worst_.momentumDrift);
  keepLargest(metricOf("angular_momentum_drift", sample), worst_.angularMomentumDrift);
}

StudyTrace truthOf(const StudyCase& study, const StudyTrace* self) {
  StudyTrace truth;
  truth.samples = study.sampleCount();
  ReferenceTable table;
  if (!study.reference.table.empty()) table = chosenRows(study.reference);
  for (std::size_t q = 0; q < study.quantities.size(); ++q) {
    const StudyQuantity& quantity = study.quantities[q];
    if (!quantity.columns.empty()) {
      truth.quantities.push_back(tableSamples(study, quantity, table));
    } else if (!quantity.law.empty() || self == nullptr) {
      truth.quantities.push_back(lawSamples(study, quantity));
    } else {
      truth.quantities.push_back(self->quantities[q]);
    }
  }
  return truth;
}

StudyErrors compare(const StudyCase& study, const StudyTrace& trace, const StudyTrace& truth) {
  StudyErrors result;
  std::vector<double> errors;
  for (int k = 0; k < study.sampleCount(); ++k) {
    const double error = normAt(study, trace, truth, k);
    if (error >= 0 || std::isnan(error)) errors.push_back(error);
  }
  const double numbers = squareOfNumbers(study, trace, truth);
  const double each = reduceErrors(study.error, errors);
  const bool isSquare = study.error == StudyCase::Error::kMeanSquare;
  result.error = isSquare ? each + numbers : std::sqrt(each * each + numbers);
  result.last = std::hypot(errors.empty() ? 0 : errors.back(), std::sqrt(numbers));
  result.compared = static_cast<int>(errors.size());
  return result;
}

std::optional<double> tableAccuracy(const StudyCase& study) {
  const StudyReference& reference = study.reference;
  if (reference.accuracyColumn.empty()) return reference.accuracy;
  const ReferenceTable table = chosenRows(reference);
  const auto time = static_cast<std::size_t>(table.column(reference.time));
  const auto column = static_cast<std::size_t>(table.column(reference.accuracyColumn));
  double worst = 0;
  for (const std::vector<double>& row : table.rows) {
    const bool isCompared = row[time] <= study.trustedUntil.value_or(study.duration) + 1e-9;
    if (isCompared && std::isfinite(row[column])) worst = std::max(worst, row[column]);
  }
  return worst;
}

}  // namespace scenes

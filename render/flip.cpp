// FLIP: numbers in brackets are the paper's equations.
#include "render/flip.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace render {
namespace {

using Triple = Eigen::Vector3f;

struct Channel {  // of one number a pixel
  int width = 0, height = 0;
  std::vector<float> values;
  float at(int x, int y) const {
    return values[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(x)];
  }
};

float linearOf(std::uint8_t level) {
  const float s = static_cast<float>(level) / 255;
  return s > 0.04045f ? std::pow((s + 0.055f) / 1.055f, 2.4f) : s / 12.92f;
}

// Linear sRGB to XYZ, D65.
Eigen::Matrix3f toXyz() {
  Eigen::Matrix3f m;
  m << 10135552.0f / 24577794, 8788810.0f / 24577794, 4435075.0f / 24577794, 2613072.0f / 12288897,
      8788810.0f / 12288897, 887015.0f / 12288897, 1425312.0f / 73733382.0f,
      8788810.0f / 73733382.0f, 70074185.0f / 73733382.0f;
  return m;
}

const Eigen::Matrix3f kToXyz = toXyz(), kFromXyz = kToXyz.inverse();
const Triple kWhite = kToXyz * Triple::Ones();

// Linearised L*a*b*: sums of light stay sums.
Triple toYcc(const Triple& rgb) {
  const Triple n = (kToXyz * rgb).cwiseQuotient(kWhite);
  return {116 * n.y() - 16, 500 * (n.x() - n.y()), 200 * (n.y() - n.z())};
}

Triple fromYcc(const Triple& ycc) {
  const float y = (ycc.x() + 16) / 116;
  return kFromXyz * Triple(y + ycc.y() / 500, y, y - ycc.z() / 200).cwiseProduct(kWhite);
}

// L*a*b*, its colours weighed by lightness (Hunt), (5).
Triple toHuntLab(const Triple& rgb) {
  constexpr float kDelta = 6.0f / 29;
  const auto f = [](float t) {
    return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3 * kDelta * kDelta) + 4.0f / 29;
  };
  const Triple n = (kToXyz * rgb).cwiseQuotient(kWhite).unaryExpr(f);
  const float light = 116 * n.y() - 16;
  return {light, 0.01f * light * 500 * (n.x() - n.y()), 0.01f * light * 200 * (n.y() - n.z())};
}

float hyab(const Triple& a, const Triple& b) {  // (7)
  return std::abs(a.x() - b.x()) + (a - b).tail<2>().norm();
}

// Along x, then along y; the border's pixels go on outside.
Channel filtered(const Channel& in, const std::vector<float>& along,
                 const std::vector<float>& across) {
  const int radius = static_cast<int>(along.size()) / 2;
  Channel middle = in, out = in;
  const auto pass = [&](const Channel& from, Channel& to, const std::vector<float>& weights, int dx,
                        int dy) {
    for (int y = 0; y < in.height; ++y) {
      for (int x = 0; x < in.width; ++x) {
        float sum = 0;
        for (int k = -radius; k <= radius; ++k) {
          sum += weights[static_cast<std::size_t>(k + radius)] *
                 from.at(std::clamp(x + k * dx, 0, in.width - 1),
                         std::clamp(y + k * dy, 0, in.height - 1));
        }
        to.values[static_cast<std::size_t>(y) * static_cast<std::size_t>(in.width) +
                  static_cast<std::size_t>(x)] = sum;
      }
    }
  };
  pass(in, middle, along, 1, 0);
  pass(middle, out, across, 0, 1);
  return out;
}

// The eye's contrast sensitivity as a sum of Gaussians a sqrt(pi/b) exp(-pi^2 x^2 / b), Table 1.
struct Sensitivity {
  double a1, b1, a2, b2;
};
constexpr Sensitivity kSensitivities[3] = {
    {1, 0.0047, 0, 1e-5}, {1, 0.0053, 0, 1e-5}, {34.1, 0.04, 13.5, 0.025}};

Channel blurred(const Channel& in, const Sensitivity& s, double pixelsPerDegree) {
  const int radius =
      static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * M_PI * M_PI)) * pixelsPerDegree));
  Channel out = in;
  std::fill(out.values.begin(), out.values.end(), 0.0f);
  double total = 0;
  for (const auto& [a, b] : {std::pair(s.a1, s.b1), std::pair(s.a2, s.b2)}) {
    if (a == 0) continue;
    std::vector<float> weights;
    double sum = 0;
    for (int k = -radius; k <= radius; ++k) {
      const double x = k / pixelsPerDegree;
      sum += std::exp(-M_PI * M_PI * x * x / b);
      weights.push_back(static_cast<float>(std::exp(-M_PI * M_PI * x * x / b)));
    }
    const double share = a * std::sqrt(M_PI / b);
    total += share * sum * sum;
    const Channel part = filtered(in, weights, weights);
    for (std::size_t i = 0; i < out.values.size(); ++i) {
      out.values[i] += static_cast<float>(share) * part.values[i];
    }
  }
  for (float& value : out.values) value /= static_cast<float>(total);
  return out;
}

struct Seen {
  std::vector<Triple> lab;           // as seen from a distance
  std::vector<float> edges, points;  // of the lightness, from 0 to 1
};

// How strong derivatives of the lightness are, (8): first ones at edges, second ones at points.
std::vector<float> features(const Channel& light, double deviation, bool points) {
  const int radius = static_cast<int>(std::ceil(3 * deviation));
  std::vector<float> smooth, derivative;
  double sum = 0, positive = 0, negative = 0;
  for (int k = -radius; k <= radius; ++k) {
    const double g = std::exp(-k * k / (2 * deviation * deviation));
    const double d = points ? (k * k / (deviation * deviation) - 1) * g : -k * g;
    sum += g;
    (d > 0 ? positive : negative) += std::abs(d);
    smooth.push_back(static_cast<float>(g));
    derivative.push_back(static_cast<float>(d));
  }
  for (float& g : smooth) g /= static_cast<float>(sum);
  for (float& d : derivative) d /= static_cast<float>(d > 0 ? positive : negative);
  const Channel x = filtered(light, derivative, smooth), y = filtered(light, smooth, derivative);
  std::vector<float> out(light.values.size());
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = std::hypot(x.values[i], y.values[i]);
  return out;
}

Seen see(const Image& image, double pixelsPerDegree) {
  std::array<Channel, 3> ycc;
  const std::size_t count = image.rgb.size() / 3;
  for (Channel& plane : ycc) plane = {image.width, image.height, std::vector<float>(count)};
  Channel light = ycc[0];
  for (std::size_t i = 0; i < count; ++i) {
    const Triple color = toYcc({linearOf(image.rgb[3 * i]), linearOf(image.rgb[3 * i + 1]),
                                linearOf(image.rgb[3 * i + 2])});
    for (std::size_t c = 0; c < 3; ++c) ycc[c].values[i] = color[static_cast<int>(c)];
    light.values[i] = (color.x() + 16) / 116;
  }
  for (std::size_t c = 0; c < 3; ++c) ycc[c] = blurred(ycc[c], kSensitivities[c], pixelsPerDegree);
  Seen seen;
  for (std::size_t i = 0; i < count; ++i) {
    const Triple color = fromYcc({ycc[0].values[i], ycc[1].values[i], ycc[2].values[i]});
    seen.lab.push_back(toHuntLab(color.cwiseMax(0).cwiseMin(1)));
  }
  const double deviation = 0.5 * 0.082 * pixelsPerDegree;  // a feature is 0.082 degrees wide
  seen.edges = features(light, deviation, false);
  seen.points = features(light, deviation, true);
  return seen;
}

// Small differences get 95 % of the range up to 40 % of the largest, (6).
float redistributed(float power, float largest) {
  constexpr float kShare = 0.4f, kRange = 0.95f;
  const float turn = kShare * largest;
  if (power < turn) return kRange / turn * power;
  return kRange + (power - turn) / (largest - turn) * (1 - kRange);
}

}  // namespace

std::vector<float> flipErrors(const Image& want, const Image& got, double pixelsPerDegree) {
  if (want.width != got.width || want.height != got.height) {
    throw std::invalid_argument("FLIP of images of different sizes");
  }
  const Seen a = see(want, pixelsPerDegree), b = see(got, pixelsPerDegree);
  const float largest =
      std::pow(hyab(toHuntLab({0, 1, 0}), toHuntLab({0, 0, 1})), 0.7f);  // green and blue
  std::vector<float> errors(a.lab.size());
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const float color = redistributed(std::pow(hyab(a.lab[i], b.lab[i]), 0.7f), largest);
    const float feature =
        std::max(std::abs(a.edges[i] - b.edges[i]), std::abs(a.points[i] - b.points[i]));
    errors[i] = std::pow(color, 1 - std::sqrt(feature / std::sqrt(2.0f)));  // (9), (10)
  }
  return errors;
}

Flip flip(const Image& want, const Image& got) {
  std::vector<float> errors = flipErrors(want, got);
  if (errors.empty()) return {};
  double sum = 0;
  for (const float error : errors) sum += error;
  const std::size_t rank = std::min(errors.size() - 1, errors.size() * 95 / 100);
  std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(rank),
                   errors.end());
  return {sum / static_cast<double>(errors.size()), static_cast<double>(errors[rank])};
}

}  // namespace render

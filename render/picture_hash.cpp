// XXH3 over a Picture, field by field: structs have padding, and vectors their lengths.
#include "render/picture_hash.h"

#include <xxhash.h>

#include <memory>
#include <new>
#include <type_traits>

namespace render {
namespace {

class Hasher {
 public:
  Hasher() : state_(XXH3_createState(), XXH3_freeState) {
    if (!state_) throw std::bad_alloc();
    XXH3_64bits_reset(state_.get());
  }
  std::uint64_t digest() const { return XXH3_64bits_digest(state_.get()); }

  template <typename T>
  requires std::is_arithmetic_v<T> || std::is_enum_v<T>
  void add(T value) { XXH3_64bits_update(state_.get(), &value, sizeof value); }
  template <int kSize>
  void add(const Eigen::Matrix<float, kSize, 1>& v) {
    XXH3_64bits_update(state_.get(), v.data(), kSize * sizeof(float));
  }
  void add(const Eigen::Quaternionf& q) { add(Eigen::Vector4f(q.coeffs())); }
  void add(const std::string& text) {
    add(static_cast<std::uint64_t>(text.size()));
    XXH3_64bits_update(state_.get(), text.data(), text.size());
  }
  template <typename T, std::size_t kSize>
  void add(const std::array<T, kSize>& values) {
    for (const T& value : values) add(value);
  }
  template <typename T>
  void add(const std::vector<T>& values) {
    add(static_cast<std::uint64_t>(values.size()));
    if constexpr (std::is_arithmetic_v<T>) {
      XXH3_64bits_update(state_.get(), values.data(), values.size() * sizeof(T));
    } else {
      for (const T& value : values) add(value);
    }
  }
  template <typename... T>
  void addAll(const T&... values) {
    (add(values), ...);
  }

  void add(const std::shared_ptr<const Mesh>& mesh) {
    add(mesh != nullptr);
    if (mesh) addAll(mesh->positions, mesh->normals, mesh->indices);
  }
  void add(const Instance& v) {
    addAll(v.primitive, v.mesh, v.size, v.position, v.orientation, v.color, v.marked);
  }
  void add(const Surface& v) {
    addAll(v.positions, v.indices, v.grid, v.edges, v.offset, v.color, v.backColor);
  }
  void add(const Camera& v) { addAll(v.eye, v.target, v.up, v.fieldOfViewDegrees); }
  void add(const Ground& v) { addAll(v.visible, v.height, v.spacing, v.color); }
  void add(const Light& v) { addAll(v.direction, v.shadows, v.color, v.softness); }
  void add(const Line& v) { addAll(v.from, v.to, v.color, v.width, v.arrow, v.onTop); }
  void add(const Dot& v) { addAll(v.at, v.color, v.diameter); }
  void add(const Label& v) { addAll(v.at, v.text, v.offset, v.color, v.size, v.anchor); }
  void add(const Plot::Curve& v) { addAll(v.name, v.values, v.color); }
  void add(const Plot& v) { addAll(v.title, v.unit, v.curves, v.length, v.logarithmic); }
  void add(const Bar& v) { addAll(v.name, v.value, v.end, v.now); }
  void add(const Hud& v) {
    addAll(v.visible, v.title, v.rows, v.plots);
    if (!v.bars.empty()) add(v.bars);
  }
  void add(const Picture& v) {
    addAll(v.camera, v.light, v.ground, v.instances, v.lines, v.dots, v.labels, v.hud, v.caption,
           v.background, v.focusCenter, v.focusRadius);
    if (!v.surfaces.empty()) add(v.surfaces);  // pictures without any keep their hash
  }

 private:
  std::unique_ptr<XXH3_state_t, XXH_errorcode (*)(XXH3_state_t*)> state_;
};

}  // namespace

std::uint64_t pictureHash(const Picture& picture) {
  Hasher hasher;
  hasher.add(picture);
  return hasher.digest();
}

}  // namespace render

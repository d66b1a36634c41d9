// A state as bytes, and back: one list of members per type, `archive(Archive&, T&)` beside the type
// or as its member, is walked by whoever writes and by whoever reads, so that they cannot differ.
// Exact: numbers are kept as they lie in memory.
#pragma once

#include <array>
#include <cstring>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "physics/base/types.h"

namespace physics {

class Archive {
 public:
  explicit Archive(std::string& to) : to_(&to) {}           // writes, at its end
  explicit Archive(std::string_view from) : from_(from) {}  // reads

  bool reads() const { return to_ == nullptr; }
  bool isAtEnd() const { return from_.empty(); }  // of what it reads

  // Throws std::invalid_argument where the bytes end before the members.
  template <class... T>
  void operator()(T&... members) {
    (take(members), ...);
  }

  // Of a list of fixed length that is filled so far; the rest is as it begins.
  template <class T, std::size_t N>
  void first(int count, std::array<T, N>& list) {
    require(count >= 0 && count <= static_cast<int>(N), "the state holds a count out of bounds");
    if (reads()) list = {};
    for (int k = 0; k < count; ++k) take(list[k]);
  }

  // The same in both: a reader throws std::invalid_argument where the bytes say another.
  template <class T>
  void expect(const T& here, const char* what) {
    T there = here;
    take(there);
    require(there == here, std::string("the state is that of another world: ") + what);
  }

 private:
  void bytes(void* at, std::size_t count) {
    if (to_ != nullptr) {
      to_->append(static_cast<const char*>(at), count);
      return;
    }
    require(count <= from_.size(), "the state ends too early");
    std::memcpy(at, from_.data(), count);
    from_.remove_prefix(count);
  }
  std::size_t size(std::size_t here) {
    std::uint64_t count = here;
    take(count);
    require(!reads() || count <= 8 * from_.size(), "the state ends too early");  // bits are packed
    return static_cast<std::size_t>(count);
  }

  template <class T>
  void take(T& value) {
    if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>) {
      bytes(&value, sizeof value);
    } else if constexpr (requires { value.archive(*this); }) {
      value.archive(*this);
    } else {
      archive(*this, value);
    }
  }
  template <class S, int R, int C, int O>
  void take(Eigen::Matrix<S, R, C, O>& matrix) {
    static_assert(R > 0 && C > 0);
    bytes(matrix.data(), sizeof(S) * R * C);
  }
  void take(Quat& q) { take(q.coeffs()); }
  void take(std::string& text) {
    text.resize(size(text.size()));
    bytes(text.data(), text.size());
  }
  template <class A, class B>
  void take(std::pair<A, B>& pair) {
    (*this)(pair.first, pair.second);
  }
  template <class T, std::size_t N>
  void take(std::array<T, N>& list) {
    for (T& value : list) take(value);
  }
  template <class T>
  void take(std::optional<T>& value) {
    bool has = value.has_value();
    take(has);
    if (!has) value.reset();
    if (has && !value) value.emplace(T{});
    if (has) take(*value);
  }
  template <class T>
  void take(std::vector<T>& list) {
    list.resize(size(list.size()));
    if constexpr (std::is_arithmetic_v<T>) {
      if (!list.empty()) bytes(list.data(), sizeof(T) * list.size());
    } else {
      for (T& value : list) take(value);
    }
  }
  template <class K, class V>
  void take(std::map<K, V>& map) {
    std::vector<std::pair<K, V>> list(map.begin(), map.end());
    take(list);
    if (reads()) map = {list.begin(), list.end()};
  }
  void take(std::vector<bool>& list) {
    list.resize(size(list.size()));
    for (std::size_t i = 0; i < list.size(); i += 8) {
      std::uint8_t byte = 0;
      for (std::size_t k = i; k < list.size() && k < i + 8; ++k) byte |= list[k] << (k - i);
      take(byte);
      for (std::size_t k = i; k < list.size() && k < i + 8; ++k) list[k] = byte >> (k - i) & 1;
    }
  }

  std::string* to_ = nullptr;
  std::string_view from_;
};

inline void archive(Archive& a, Pose& pose) { a(pose.x, pose.q); }
inline void archive(Archive& a, Velocity& velocity) { a(velocity.v, velocity.w); }

}  // namespace physics

// Planes of floats that a thread uses again and again: fresh memory costs a page fault every 4 KiB,
// more than what is computed on it.
#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace glint::procedural {

// n floats with whatever was in them before; n is at least 1.
class Plane {
 public:
  explicit Plane(size_t n) {
    std::vector<std::vector<float>>& kept = Kept();
    if (!kept.empty()) {
      values_ = std::move(kept.back());
      kept.pop_back();
    }
    values_.resize(n);
  }
  ~Plane() {
    if (!values_.empty() && values_.size() <= kLargestKept && Kept().size() < kMostKept) {
      Kept().push_back(std::move(values_));
    }
  }
  Plane(Plane&& other) noexcept : values_(std::exchange(other.values_, {})) {}
  Plane(const Plane&) = delete;
  Plane& operator=(const Plane&) = delete;
  Plane& operator=(Plane&&) = delete;

  float* data() { return values_.data(); }
  const float* data() const { return values_.data(); }
  size_t size() const { return values_.size(); }
  float& operator[](size_t i) { return values_[i]; }
  float operator[](size_t i) const { return values_[i]; }
  float* begin() { return data(); }
  float* end() { return data() + size(); }
  const float* begin() const { return data(); }
  const float* end() const { return data() + size(); }
  operator std::span<const float>() const { return {data(), size()}; }

 private:
  static constexpr size_t kLargestKept = size_t{1} << 20, kMostKept = 24;
  static std::vector<std::vector<float>>& Kept() {
    static thread_local std::vector<std::vector<float>> kept;
    return kept;
  }
  std::vector<float> values_;
};

}  // namespace glint::procedural

#include "base/resampling/resampling.h"

#include <algorithm>
#include <cmath>

namespace glint {
namespace {

// One block: rows are resampled into `narrow` (height rows), columns from there to `to`.
void ResamplePlane(const float* from, int width, int height, std::span<const Taps> across,
                   std::span<const Taps> down, float* narrow, float* to) {
  const size_t out_width = across.size();
  for (int y = 0; y < height; ++y) {
    const float* row = from + static_cast<size_t>(y) * width;
    for (size_t x = 0; x < out_width; ++x) {
      const Taps& taps = across[x];
      float sum = 0;
      for (size_t k = 0; k < taps.weights.size(); ++k) sum += taps.weights[k] * row[taps.first + k];
      narrow[y * out_width + x] = sum;
    }
  }
  for (const Taps& taps : down) {
    std::fill_n(to, out_width, 0.0f);
    for (size_t k = 0; k < taps.weights.size(); ++k) {
      const float weight = taps.weights[k];
      const float* row = narrow + (taps.first + k) * out_width;
      for (size_t x = 0; x < out_width; ++x) to[x] += weight * row[x];
    }
    to += out_width;
  }
}

}  // namespace

std::vector<Overlaps> AreaOverlaps(int input, int output) {
  std::vector<Overlaps> all(output);
  for (int i = 0; i < output; ++i) {
    const double begin = static_cast<double>(i) * input / output;
    const double end = static_cast<double>(i + 1) * input / output;
    all[i].first = static_cast<int>(begin);
    for (int k = all[i].first; k < input && k < end; ++k) {
      all[i].shares.push_back(std::min(end, k + 1.0) - std::max(begin, static_cast<double>(k)));
    }
  }
  return all;
}

std::vector<Taps> AreaTaps(int input, int output) {
  const double scale = static_cast<double>(input) / output;
  std::vector<Taps> all;
  for (const Overlaps& overlaps : AreaOverlaps(input, output)) {
    Taps taps{overlaps.first, {}};
    for (const double share : overlaps.shares) {
      taps.weights.push_back(static_cast<float>(share / scale));
    }
    all.push_back(std::move(taps));
  }
  return all;
}

std::vector<Taps> TentTaps(int input, int output) {
  std::vector<Taps> all(output);
  const double scale = static_cast<double>(input) / output, radius = std::max(1.0, scale);
  for (int i = 0; i < output; ++i) {
    const double centre = (i + 0.5) * scale;
    const int begin = std::max(0, static_cast<int>(std::floor(centre - radius)));
    const int end = std::min(input, static_cast<int>(std::ceil(centre + radius)));
    double sum = 0;
    all[i].first = begin;
    for (int k = begin; k < end; ++k) {
      const double weight = std::max(0.0, 1.0 - std::abs(k + 0.5 - centre) / radius);
      all[i].weights.push_back(static_cast<float>(weight));
      sum += weight;
    }
    for (float& weight : all[i].weights) weight = static_cast<float>(weight / sum);
  }
  return all;
}

std::vector<Taps> TapsBetween(int input, int output) {
  return input > output ? AreaTaps(input, output) : TentTaps(input, output);
}

std::vector<TapGroup> GroupTaps(std::span<const Taps> taps, int most_inputs) {
  std::vector<TapGroup> groups;
  for (size_t i = 0; i < taps.size(); ++i) {
    const int end = taps[i].first + static_cast<int>(taps[i].weights.size());
    if (groups.empty() || end - groups.back().first_input > most_inputs) {
      groups.push_back({static_cast<int>(i), taps[i].first, 0, {}});
    }
    TapGroup& group = groups.back();
    group.inputs = std::max(group.inputs, end - group.first_input);
    group.taps.push_back(taps[i]);
    group.taps.back().first -= group.first_input;
  }
  return groups;
}

std::vector<float> ResamplePlanes(std::span<const float> planes, int width, int height,
                                  std::span<const Taps> across, std::span<const Taps> down) {
  const size_t in_size = static_cast<size_t>(width) * height;
  const size_t out_size = across.size() * down.size();
  const size_t count = planes.size() / in_size;
  std::vector<float> narrow(across.size() * height), out(count * out_size);
  for (size_t p = 0; p < count; ++p) {
    ResamplePlane(planes.data() + p * in_size, width, height, across, down, narrow.data(),
                  out.data() + p * out_size);
  }
  return out;
}

std::vector<float> CutRows(std::span<const float> planes, int width, int height, int first,
                           int rows) {
  const size_t row = static_cast<size_t>(width), plane = row * static_cast<size_t>(height);
  const size_t begin = static_cast<size_t>(first) * row, count = static_cast<size_t>(rows) * row;
  std::vector<float> cut;
  cut.reserve(planes.size() / plane * count);
  for (size_t at = 0; at < planes.size(); at += plane) {
    const auto block = planes.subspan(at + begin, count);
    cut.insert(cut.end(), block.begin(), block.end());
  }
  return cut;
}

void PutRows(std::span<const float> rows, int width, int height, int first,
             std::span<float> planes) {
  if (rows.empty()) return;
  const size_t row = static_cast<size_t>(width), plane = row * static_cast<size_t>(height);
  const size_t count = rows.size() / (planes.size() / plane);
  size_t to = static_cast<size_t>(first) * row;
  for (size_t from = 0; from < rows.size(); from += count, to += plane) {
    const auto block = rows.subspan(from, count);
    std::copy(block.begin(), block.end(), planes.begin() + static_cast<std::ptrdiff_t>(to));
  }
}

std::vector<float> PickEvery(std::span<const float> planes, int width, int height, int stride) {
  const size_t row = static_cast<size_t>(width), plane = row * static_cast<size_t>(height);
  const auto step = static_cast<size_t>(stride);
  std::vector<float> picked;
  for (size_t block = 0; block < planes.size(); block += plane) {
    for (size_t r = step / 2; r < static_cast<size_t>(height); r += step) {
      for (size_t c = step / 2; c < row; c += step) picked.push_back(planes[block + r * row + c]);
    }
  }
  return picked;
}

std::pair<int, int> SizeAtMost(int width, int height, int most) {
  const int side = std::max(width, height);
  if (side <= most) return {width, height};
  const auto scaled = [&](int length) {
    return std::max(1, static_cast<int>(std::lround(static_cast<double>(length) * most / side)));
  };
  return {scaled(width), scaled(height)};
}

}  // namespace glint

// Regular grids of samples at another size, one axis after the other. Sample i of n covers
// [i, i + 1)/n of the axis.
#pragma once

#include <span>
#include <utility>
#include <vector>

namespace glint {

// The input samples that make one output sample: first, first + 1, …, and their weights.
struct Taps {
  int first = 0;
  std::vector<float> weights;  // sum: 1
};

// The input samples that lie in one output sample, and how much of each.
struct Overlaps {
  int first = 0;
  std::vector<double> shares;  // 0 … 1; sum: input / output
};

// One entry per output sample; 1 ≤ output ≤ input. For averages that weigh samples by more than
// their area.
std::vector<Overlaps> AreaOverlaps(int input, int output);

// Area average: AreaOverlaps() as weights.
std::vector<Taps> AreaTaps(int input, int output);

// Triangle filter as wide as two samples of the coarser grid: bilinear up, tent-averaged down.
std::vector<Taps> TentTaps(int input, int output);

// AreaTaps() to fewer samples, TentTaps() to as many or more.
std::vector<Taps> TapsBetween(int input, int output);

// Consecutive output samples and the input samples that make them, as few at a time as fit into
// memory.
struct TapGroup {
  int first_output = 0;
  int first_input = 0, inputs = 0;
  std::vector<Taps> taps;  // of the outputs, `first` counted from first_input
};
// At most `most_inputs` in a group, more only where one output needs more. `taps` as those above:
// later ones never begin earlier.
std::vector<TapGroup> GroupTaps(std::span<const Taps> taps, int most_inputs);

// `planes` holds blocks of width × height samples, row by row; returns as many blocks of
// across.size() × down.size(), in the same order.
std::vector<float> ResamplePlanes(std::span<const float> planes, int width, int height,
                                  std::span<const Taps> across, std::span<const Taps> down);

// Rows first … first + rows − 1 of blocks of width × height samples, as blocks of width × rows.
std::vector<float> CutRows(std::span<const float> planes, int width, int height, int first,
                           int rows);
// The inverse: `rows` into blocks of width × height samples, from row `first` on.
void PutRows(std::span<const float> rows, int width, int height, int first,
             std::span<float> planes);

// The sample in the middle of every stride × stride (the last ones maybe cut off before it).
std::vector<float> PickEvery(std::span<const float> planes, int width, int height, int stride);

// Width and height with no side above `most`, in the same proportion; at least 1.
std::pair<int, int> SizeAtMost(int width, int height, int most);

}  // namespace glint

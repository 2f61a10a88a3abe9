// Has a refiner go over the rows of a sample, as many in memory as are allowed.
#pragma once

#include <algorithm>
#include <array>
#include <optional>

#include "fitting/refine/refine_rows.h"
#include "fitting/refine/sample_source.h"

namespace glint {

// Rows of a sample, some at a time. Those that were taken last are kept: of a sample that fits in
// memory nothing is read twice.
class RowReader {
 public:
  RowReader(SampleSource* source, int rows_at_once, int threads)
      : source_(*source), rows_at_once_(rows_at_once), threads_(threads) {}

  // Has the refiner take, and then visit(), all rows of its step.
  template <class Visit>
  void ForEach(int step, RowRefiner* refiner, const Visit& visit) {
    const RowSpan rows = refiner->RowsOf(step);
    for (int first = rows.first; first < rows.last; first += rows_at_once_) {
      Take({first, std::min(first + rows_at_once_, rows.last)}, refiner->RowsAbout(step), refiner);
      visit();
    }
  }

 private:
  void Take(RowSpan rows, int about, RowRefiner* refiner) {
    const int above = std::min(rows.first, about);
    const int below = std::min(source_.plane().height - rows.last, about);
    const std::array<int, 4> these = {rows.first, rows.last, above, below};
    if (part_ && these == taken_) return;
    part_.reset();
    part_.emplace(source_.Rows(rows.first - above, above + rows.size() + below, threads_));
    refiner->Take(part_->Problem(), part_->start, above, below);
    taken_ = these;
  }

  SampleSource& source_;
  const int rows_at_once_, threads_;
  std::optional<SampleSource::Part> part_;
  std::array<int, 4> taken_{};
};

}  // namespace glint

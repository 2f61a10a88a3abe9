// Rows of a picture between two steps of a computation, where all of them need not fit in memory.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

namespace glint {

class ScratchRows {
 public:
  // Of `width` texels, `planes` values each. In a file without a name in `folder`, which no crash
  // leaves behind; "": in memory. Throws EnvironmentError: no such file can be made.
  ScratchRows(const std::filesystem::path& folder, int width, int planes);
  ~ScratchRows();
  ScratchRows(const ScratchRows&) = delete;
  ScratchRows& operator=(const ScratchRows&) = delete;

  // `rows`: planes of whole rows, the first of them `first_row` ≥ 0; any rows in any order. Throws
  // EnvironmentError (disk full).
  void Write(int first_row, std::span<const float> rows);
  // Planes of so many rows. Of rows never written: zeros.
  std::vector<float> Read(int first_row, int rows) const;

 private:
  std::filesystem::path folder_;
  size_t width_, planes_;
  int descriptor_ = -1;
};

}  // namespace glint

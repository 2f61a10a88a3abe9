// Rectified views read and written by rows: views of 16384² texels need 4 GB each.
#pragma once

#include "base/formats/rectified_set.h"
#include "base/images/exr_rows.h"

namespace glint {

class RectifiedReader {
 public:
  // Throws UserError when size or channels do not fit the set.
  RectifiedReader(const RectifiedSet& set, const RectifiedView& view);
  // Rows first_row … first_row + rows − 1. Throws UserError: values that are not finite.
  RectifiedImage Read(int first_row, int rows);

 private:
  std::filesystem::path file_;
  ExrReader reader_;
  std::array<int, 4> channels_;  // of R, G, B and the mask
};

class RectifiedWriter {
 public:
  // Half floats for a photograph of 8 or 16 bit: they round by .014 % (standard deviation), where a
  // step of 8 bit is .9 % at white and photon noise of 30,000 electrons .6 %. Float for others.
  // Throws EnvironmentError, as all that follows.
  RectifiedWriter(const std::filesystem::path& file, const RectifiedSet& set,
                  const RectifiedView& view);
  // The next rows, from the top.
  void Write(const RectifiedImage& rows);
  void Close() { writer_.Close(); }

 private:
  ExrWriter writer_;
};

}  // namespace glint

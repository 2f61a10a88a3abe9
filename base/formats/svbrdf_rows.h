// svbrdf.exr read and written by rows: maps of 16384² texels need 11 GB.
#pragma once

#include "base/images/exr_rows.h"
#include "base/reflectance/convention.h"
#include "base/reflectance/svbrdf_maps.h"
#include "base/resampling/resampling.h"

namespace glint {

class SvbrdfReader {
 public:
  // Throws UserError: a missing channel, no convention (where one is asked for).
  explicit SvbrdfReader(const std::filesystem::path& file,
                        ReflectanceConvention* convention = nullptr);
  int width() const { return reader_.width(); }
  int height() const { return reader_.height(); }
  // Rows first_row … first_row + rows − 1. Throws UserError: a value out of range or not finite.
  SvbrdfMaps Read(int first_row, int rows);

 private:
  std::filesystem::path file_;
  ExrReader reader_;
  std::array<int, kSvbrdfPlanes> channels_;
};

class SvbrdfWriter {
 public:
  // Throws EnvironmentError, as all that follows.
  SvbrdfWriter(const std::filesystem::path& file, int width, int height,
               const ReflectanceConvention& convention);
  // The next rows, from the top.
  void Write(const SvbrdfMaps& rows);
  void Close() { writer_.Close(); }

 private:
  ExrWriter writer_;
};

// The file's maps at another size, as ResampleSvbrdf makes them, or a part of those.
class ResampledSvbrdf {
 public:
  // Throws UserError.
  ResampledSvbrdf(const std::filesystem::path& file, int width, int height,
                  ReflectanceConvention* convention = nullptr);
  int width() const { return static_cast<int>(across_.size()); }
  int height() const { return static_cast<int>(down_.size()); }
  SvbrdfMaps Read(int first_row, int rows);

 private:
  SvbrdfReader reader_;
  std::vector<Taps> across_, down_;
};

}  // namespace glint

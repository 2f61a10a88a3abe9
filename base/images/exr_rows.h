// EXR images read and written by rows, so that a large one is never whole in memory.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "base/images/image.h"

namespace glint {

// Threads that compress and decompress blocks of 32 rows side by side, from the first image on; 1,
// the default: the caller's alone. The bytes are the same. To be called before any image is opened.
void SetExrThreads(int threads);

// How samples are stored. kHalf (IEEE binary16) rounds by at most 2⁻¹¹ of a value from 6.1e-5 on,
// absolutely by 3e-8 below; what exceeds its range becomes the largest, 65504.
enum class ExrPrecision { kFloat, kHalf };

// Any EXR; channels in file order.
class ExrReader {
 public:
  // Throws UserError: missing, no OpenEXR image, too large.
  explicit ExrReader(const std::filesystem::path& file);
  ~ExrReader();
  ExrReader(ExrReader&&) noexcept;

  int width() const;
  int height() const;
  const std::vector<std::string>& channels() const { return channels_; }
  ExrPrecision precision() const;
  // Those that WriteExr and ExrWriter were given.
  const std::map<std::string, std::string>& attributes() const { return attributes_; }

  // Rows first_row … first_row + rows − 1, which must lie in the image. In any order; going down is
  // cheapest. Throws UserError: the file ends early, or the rows need more memory than allowed.
  Image Read(int first_row, int rows);

 private:
  struct Input;
  std::filesystem::path file_;
  std::unique_ptr<Input> input_;
  std::vector<std::string> channels_;
  std::map<std::string, std::string> attributes_;
};

// The named channels, averaged to the size; those of the file at most. Throws UserError: a channel
// is missing.
Image ReadExrAveraged(const std::filesystem::path& file, const std::vector<std::string>& channels,
                      int width, int height);

// Scan-line EXR as WriteExr makes it: the same bytes, whatever rows are written together.
class ExrWriter {
 public:
  // Throws EnvironmentError.
  ExrWriter(const std::filesystem::path& file, int width, int height,
            const std::vector<std::string>& channels,
            const std::map<std::string, std::string>& attributes = {},
            ExrPrecision precision = ExrPrecision::kFloat);
  ~ExrWriter();
  ExrWriter(ExrWriter&&) noexcept;

  // The next rows, from the top. Throws EnvironmentError, and removes the file.
  void Write(const Image& rows);
  // After the last row. Throws EnvironmentError, and removes the file.
  void Close();

 private:
  struct Output;
  [[noreturn]] void Fail(const std::string& reason);
  void WriteFloats(const Image& rows);
  void WriteHalves(const Image& rows);
  std::filesystem::path file_;
  std::unique_ptr<Output> output_;
  int next_row_ = 0;
};

}  // namespace glint

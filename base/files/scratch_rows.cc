#include "base/files/scratch_rows.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <string>

#include "base/errors/errors.h"

namespace glint {
namespace {

[[noreturn]] void Throw(const std::filesystem::path& folder, const std::string& action, int error) {
  const std::string where = folder.empty() ? "memory" : folder.string();
  throw EnvironmentError(where + ": cannot " + action + " scratch rows: " + std::strerror(error) +
                         "; free some space or use another folder");
}

// By `transfer`, which may move fewer bytes than asked for. Returns how many were there; less with
// `error` 0: the file ends.
template <class Transfer>
size_t Moved(size_t bytes, int* error, const Transfer& transfer) {
  size_t done = 0;
  while (done < bytes) {
    const ssize_t moved = transfer(done, bytes - done);
    if (moved < 0 && errno == EINTR) continue;
    if (moved < 0) *error = errno;
    if (moved <= 0) break;
    done += static_cast<size_t>(moved);
  }
  return done;
}

}  // namespace

ScratchRows::ScratchRows(const std::filesystem::path& folder, int width, int planes)
    : folder_(folder), width_(static_cast<size_t>(width)), planes_(static_cast<size_t>(planes)) {
  if (folder.empty()) {
    descriptor_ = ::memfd_create("scratch rows", MFD_CLOEXEC);
  } else {
    std::string name = (folder / ".scratch-XXXXXX").string();
    descriptor_ = ::mkostemp(name.data(), O_CLOEXEC);
    if (descriptor_ >= 0) ::unlink(name.c_str());
  }
  if (descriptor_ < 0) Throw(folder_, "make", errno);
}

ScratchRows::~ScratchRows() { ::close(descriptor_); }

// A row's planes lie one after the other.
void ScratchRows::Write(int first_row, std::span<const float> rows) {
  const size_t row_values = planes_ * width_, count = rows.size() / row_values;
  std::vector<float> row(row_values);
  for (size_t r = 0; r < count; ++r) {
    for (size_t p = 0; p < planes_; ++p) {
      std::memcpy(&row[p * width_], &rows[(p * count + r) * width_], width_ * sizeof(float));
    }
    const size_t bytes = row_values * sizeof(float);
    const auto begin = (static_cast<std::uint64_t>(first_row) + r) * bytes;
    const auto* from = reinterpret_cast<const char*>(row.data());
    int error = 0;
    const size_t written = Moved(bytes, &error, [&](size_t done, size_t left) {
      return ::pwrite(descriptor_, from + done, left, static_cast<off_t>(begin + done));
    });
    if (written < bytes) Throw(folder_, "write", error != 0 ? error : ENOSPC);
  }
}

std::vector<float> ScratchRows::Read(int first_row, int rows) const {
  const size_t row_values = planes_ * width_, count = static_cast<size_t>(rows);
  std::vector<float> planes(row_values * count), row(row_values);
  for (size_t r = 0; r < count; ++r) {
    const size_t bytes = row_values * sizeof(float);
    const auto begin = (static_cast<std::uint64_t>(first_row) + r) * bytes;
    auto* to = reinterpret_cast<char*>(row.data());
    int error = 0;
    const size_t read = Moved(bytes, &error, [&](size_t done, size_t left) {
      return ::pread(descriptor_, to + done, left, static_cast<off_t>(begin + done));
    });
    if (error != 0) Throw(folder_, "read", error);
    std::memset(to + read, 0, bytes - read);
    for (size_t p = 0; p < planes_; ++p) {
      std::memcpy(&planes[(p * count + r) * width_], &row[p * width_], width_ * sizeof(float));
    }
  }
  return planes;
}

}  // namespace glint

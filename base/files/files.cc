#include "base/files/files.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "base/errors/errors.h"

namespace glint {
namespace {

[[noreturn]] void ThrowErrno(const std::filesystem::path& file, const std::string& action) {
  const int error = errno;
  std::string remedy = "check the folder and its permissions";
  if (error == ENOSPC || error == EDQUOT || error == EFBIG)
    remedy = "free some space and run again";
  if (error == EROFS || error == EACCES) remedy = "make the folder writable";
  throw EnvironmentError(file.string() + ": cannot " + action + ": " + std::strerror(error) + "; " +
                         remedy);
}

// A descriptor that closes itself; Close() reports what close() says.
class Descriptor {
 public:
  explicit Descriptor(int value) : value_(value) {}
  ~Descriptor() {
    if (value_ >= 0) ::close(value_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return value_; }
  bool Close() {
    const int value = value_;
    value_ = -1;
    return ::close(value) == 0;
  }

 private:
  int value_;
};

}  // namespace

std::string ReadTextFile(const std::filesystem::path& file, std::size_t limit_bytes) {
  std::error_code error;
  if (!std::filesystem::exists(file, error)) {
    throw UserError(file, "", "no such file", "check the path");
  }
  if (!std::filesystem::is_regular_file(file, error)) {
    throw UserError(file, "", "something that is not a file", "give the path of a file");
  }
  const auto size = std::filesystem::file_size(file, error);
  if (error || size > limit_bytes) {
    throw UserError(file, "", std::to_string(size) + " bytes",
                    "a file of at most " + std::to_string(limit_bytes) + " bytes is expected here");
  }
  std::ifstream stream(file, std::ios::binary);
  std::string text(size, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(size));
  if (!stream) throw UserError(file, "", "a file that cannot be read", "check its permissions");
  return text;
}

void WriteFileAtomically(const std::filesystem::path& file, std::string_view bytes) {
  const std::filesystem::path beside = file.string() + ".tmp" + std::to_string(::getpid());
  {
    Descriptor descriptor(::open(beside.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
    if (descriptor.get() < 0) ThrowErrno(beside, "create the file");
    const char* next = bytes.data();
    size_t left = bytes.size();
    while (left > 0) {
      const ssize_t written = ::write(descriptor.get(), next, left);
      if (written < 0 && errno == EINTR) continue;
      if (written <= 0) {
        const int error = errno;
        ::unlink(beside.c_str());
        errno = error;
        ThrowErrno(file, "write the file");
      }
      next += written;
      left -= static_cast<size_t>(written);
    }
    if (::fsync(descriptor.get()) != 0 || !descriptor.Close()) ThrowErrno(file, "write the file");
  }
  if (::rename(beside.c_str(), file.c_str()) != 0) ThrowErrno(file, "replace the file");
}

std::string FileNameOf(const std::string& text) {
  const auto plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
  };
  std::string name;
  for (const char c : text) {
    name += plain(c) || c == '-' || c == '_' || c == '.' ? c : '_';
  }
  return name.empty() || !plain(name[0]) ? "m" + name : name;
}

FileLock::FileLock(const std::filesystem::path& file, const std::string& what) {
  descriptor_ = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor_ < 0) ThrowErrno(file, "create the lock file");
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
    ::close(descriptor_);
    throw UserError(file, "", "a lock held by another process (" + what + ")",
                    "wait until it has ended, or stop it");
  }
}

FileLock::~FileLock() { ::close(descriptor_); }

}  // namespace glint

#include "base/files/hash.h"

#include <xxhash.h>

#include <cstdio>
#include <memory>
#include <vector>

#include "base/errors/errors.h"

namespace glint {
namespace {

std::string Hex(XXH128_hash_t hash) {
  char text[40];
  std::snprintf(text, sizeof(text), "xxh3:%016llx%016llx",
                static_cast<unsigned long long>(hash.high64),
                static_cast<unsigned long long>(hash.low64));
  return text;
}

}  // namespace

std::string HashBytes(std::string_view bytes) {
  return Hex(XXH3_128bits(bytes.data(), bytes.size()));
}

std::string HashFile(const std::filesystem::path& file) {
  // Devices and pipes have no end, or wait for someone to write.
  std::error_code error;
  if (std::filesystem::exists(file, error) && !std::filesystem::is_regular_file(file, error)) {
    throw UserError(file, "", "something that is not a file", "give the path of a file");
  }
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(std::fopen(file.c_str(), "rb"),
                                                               &std::fclose);
  const std::unique_ptr<XXH3_state_t, XXH_errorcode (*)(XXH3_state_t*)> state(XXH3_createState(),
                                                                              &XXH3_freeState);
  if (!stream) throw UserError(file, "", "no readable file", "check the path and its permissions");
  XXH3_128bits_reset(state.get());
  std::vector<char> buffer(1 << 20);
  while (const size_t read = std::fread(buffer.data(), 1, buffer.size(), stream.get())) {
    XXH3_128bits_update(state.get(), buffer.data(), read);
  }
  if (std::ferror(stream.get())) {
    throw UserError(file, "", "a file that cannot be read",
                    "check that it is a file, not a folder");
  }
  return Hex(XXH3_128bits_digest(state.get()));
}

}  // namespace glint

#include "pipeline/studio/access/token.h"

#include <sys/random.h>

#include <array>

#include "base/errors/errors.h"

namespace glint {

std::string RandomToken() {
  std::array<unsigned char, 16> bytes;
  if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) {
    throw EnvironmentError(
        "the kernel supplies no random numbers; Studio's address cannot be kept secret");
  }
  constexpr char kDigits[] = "0123456789abcdef";
  std::string token;
  for (const unsigned char byte : bytes) {
    token += kDigits[byte >> 4];
    token += kDigits[byte & 15];
  }
  return token;
}

bool SameSecret(std::string_view secret, std::string_view found) {
  if (secret.empty() || secret.size() != found.size()) return false;
  unsigned char difference = 0;
  for (size_t i = 0; i < secret.size(); ++i) {
    difference = static_cast<unsigned char>(difference | (secret[i] ^ found[i]));
  }
  return difference == 0;
}

}  // namespace glint

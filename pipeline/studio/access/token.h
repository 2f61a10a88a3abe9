// Secrets that stand in addresses and cookies.
#pragma once

#include <string>
#include <string_view>

namespace glint {

// 128 random bits of the kernel as 32 hexadecimal digits.
std::string RandomToken();

// In a time that does not tell how much of it agrees. False for an empty secret.
bool SameSecret(std::string_view secret, std::string_view found);

}  // namespace glint

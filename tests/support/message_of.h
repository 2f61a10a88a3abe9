// What an error says.
#pragma once

#include <string>

namespace glint::test {

// The message of the exception of type E that `action` throws; "" when it throws none.
template <class E, class Action>
std::string MessageOf(const Action& action) {
  try {
    action();
  } catch (const E& error) {
    return error.what();
  }
  return "";
}

}  // namespace glint::test

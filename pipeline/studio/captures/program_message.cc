#include "pipeline/studio/captures/program_message.h"

#include <sstream>

namespace glint {
namespace {

constexpr char kErrorMark[] = ": error: ";
constexpr size_t kMost_bytes = 2000;

}  // namespace

ProgramMessage SplitMessage(const std::string& sentence) {
  const size_t cut = sentence.rfind("; ");
  if (cut == std::string::npos) return {sentence, ""};
  return {sentence.substr(0, cut), sentence.substr(cut + 2)};
}

ProgramMessage MessageIn(const std::string& log) {
  std::istringstream lines(log);
  std::string error, last;
  for (std::string line; std::getline(lines, line);) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    last = line;
    const size_t mark = line.find(kErrorMark);
    if (mark != std::string::npos && line.starts_with("glint")) {
      error = line.substr(mark + sizeof kErrorMark - 1);
    } else if (!error.empty()) {
      error += "\n" + line;
    }
  }
  if (error.empty()) error = last;
  return SplitMessage(error.substr(0, kMost_bytes));
}

}  // namespace glint

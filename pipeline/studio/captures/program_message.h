// What a program said when it failed, for a page to show.
#pragma once

#include <string>

namespace glint {

struct ProgramMessage {
  std::string message, remedy;
};

// The last "glint-NAME: error: …" of what it wrote, without the program's name, cut before its
// remedy (after the last "; "); without one the last lines.
ProgramMessage MessageIn(const std::string& log);

// The same of one sentence.
ProgramMessage SplitMessage(const std::string& sentence);

}  // namespace glint

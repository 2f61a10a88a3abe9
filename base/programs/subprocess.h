// Running a program and waiting for it. Arguments go to it as they are: no shell reads them.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace glint {

// The program `name` beside the one that runs. Throws EnvironmentError when there is none.
std::filesystem::path SiblingProgram(const std::string& name);

// The program `name` in one of PATH's folders. Throws EnvironmentError, which says how to get it
// (`install`: a command line), when there is none.
std::filesystem::path ProgramOnPath(const std::string& name, const std::string& install);

struct RunToLogOptions {
  std::vector<std::string> environment;  // more variables: "NAME=value"
  // Called about ten times a second while the program runs, to show progress.
  std::function<void()> while_running;
};

// Runs argv[0] with stdout and stderr appended to `log`. Throws ComputationError, with the last
// lines of what it said, when it ends with another exit code than 0; EnvironmentError when it
// cannot start.
void RunToLog(const std::vector<std::string>& argv, const std::filesystem::path& log,
              const RunToLogOptions& options = {});

// As RunToLog, in a process group of its own, which one signal reaches as Ctrl-C in a terminal
// does.
struct RunInGroupOptions {
  std::vector<std::string> environment;
  // Called at least five times a second. True: the group is interrupted (SIGINT), and killed where
  // it has not ended ten seconds later.
  std::function<bool()> cancelled;
};

// Returns how it ended: its exit code, or 128 + the signal. Throws EnvironmentError when it cannot
// start.
int RunInGroup(const std::vector<std::string>& argv, const std::filesystem::path& log,
               const RunInGroupOptions& options);

// Opens a file, folder or address with the program that this desktop has for it ($BROWSER,
// xdg-open …), and waits for that program. Throws EnvironmentError: there is none.
void OpenOnDesktop(const std::string& target);

}  // namespace glint

#include "base/programs/subprocess.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <string_view>
#include <thread>

#include "base/errors/errors.h"

extern char** environ;

namespace glint {
namespace {

namespace fs = std::filesystem;

constexpr size_t kTailBytes = 600;

std::string Tail(const fs::path& log) {
  std::ifstream stream(log, std::ios::binary);
  std::string text((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  if (text.size() > kTailBytes) text = "…" + text.substr(text.size() - kTailBytes);
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text;
}

// Whether one of `environment` ("NAME=value") is of the same name.
bool Replaced(std::string_view variable, const std::vector<std::string>& environment) {
  const std::string_view name = variable.substr(0, variable.find('=') + 1);
  return std::any_of(environment.begin(), environment.end(),
                     [&](const std::string& ours) { return ours.starts_with(name); });
}

// A child whose parent is killed is killed too: nothing goes on writing into a folder that the next
// run uses. (posix_spawn has no attribute for it; util-linux has, and execs the program itself.)
std::vector<std::string> DyingWithParent(std::vector<std::string> argv) {
  constexpr char kSetpriv[] = "/usr/bin/setpriv";
  // A program that cannot be started is to be our error, not setpriv's.
  if (::access(kSetpriv, X_OK) == 0 && ::access(argv[0].c_str(), X_OK) == 0) {
    argv.insert(argv.begin(), {kSetpriv, "--pdeathsig", "KILL", "--"});
  }
  return argv;
}

pid_t Spawn(const std::vector<std::string>& command, const fs::path& log,
            const std::vector<std::string>& environment, bool own_group = false) {
  const std::vector<std::string> argv = DyingWithParent(command);
  std::vector<char*> variables;
  for (const std::string& variable : environment) {
    variables.push_back(const_cast<char*>(variable.c_str()));
  }
  for (char** variable = environ; *variable != nullptr; ++variable) {
    if (!Replaced(*variable, environment)) variables.push_back(*variable);
  }
  variables.push_back(nullptr);
  std::vector<char*> pointers;
  for (const std::string& argument : argv) pointers.push_back(const_cast<char*>(argument.c_str()));
  pointers.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, 1, log.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0666);
  posix_spawn_file_actions_adddup2(&actions, 1, 2);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  // Signals that this process waits for are to reach the child all the same.
  sigset_t none;
  sigemptyset(&none);
  posix_spawnattr_setsigmask(&attributes, &none);
  // Of a group of its own, though a shell that started this process in the background had it
  // ignored.
  sigset_t interrupts;
  sigemptyset(&interrupts);
  sigaddset(&interrupts, SIGINT);
  posix_spawnattr_setsigdefault(&attributes, &interrupts);
  posix_spawnattr_setpgroup(&attributes, 0);
  const int group_flags = own_group ? POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF : 0;
  posix_spawnattr_setflags(&attributes, static_cast<short>(POSIX_SPAWN_SETSIGMASK | group_flags));
  pid_t process = 0;
  const int error = posix_spawn(&process, argv[0].c_str(), &actions, &attributes, pointers.data(),
                                variables.data());
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) {
    throw EnvironmentError(command[0] + ": cannot be started: " + std::strerror(error));
  }
  return process;
}

// What opens a page on this desktop; empty: nothing does.
fs::path Opener() {
  if (const char* browser = std::getenv("BROWSER"); browser != nullptr && *browser != '\0') {
    return browser;
  }
  constexpr std::array kOpeners = {"xdg-open",         "wslview", "open",
                                   "sensible-browser", "firefox", "chromium"};
  for (const char* name : kOpeners) {
    try {
      return ProgramOnPath(name, "");
    } catch (const EnvironmentError&) {
    }
  }
  return {};
}

}  // namespace

fs::path SiblingProgram(const std::string& name) {
  const fs::path program = fs::canonical("/proc/self/exe").parent_path() / name;
  if (!fs::exists(program)) {
    throw EnvironmentError(program.string() + ": no such program; build it first");
  }
  return program;
}

fs::path ProgramOnPath(const std::string& name, const std::string& install) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    const fs::path program = fs::path(folder.empty() ? "." : folder) / name;
    if (fs::is_regular_file(program) && ::access(program.c_str(), X_OK) == 0) return program;
  }
  throw EnvironmentError(name + ": no such program; install it with: " + install);
}

void RunToLog(const std::vector<std::string>& argv, const fs::path& log,
              const RunToLogOptions& options) {
  const pid_t process = Spawn(argv, log, options.environment);
  int status = 0;
  const int patience = options.while_running ? WNOHANG : 0;
  for (pid_t ended = 0; ended != process;) {
    ended = waitpid(process, &status, patience);
    if (ended < 0 && errno != EINTR) break;
    if (ended != 0) continue;
    options.while_running();
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
  const std::string how = WIFEXITED(status) ? "exit code " + std::to_string(WEXITSTATUS(status))
                                            : "signal " + std::to_string(WTERMSIG(status));
  throw ComputationError(argv[0] + " ended with " + how + "; see " + log.string() + ":\n" +
                         Tail(log));
}

int RunInGroup(const std::vector<std::string>& argv, const fs::path& log,
               const RunInGroupOptions& options) {
  using Clock = std::chrono::steady_clock;
  constexpr auto kPatience = std::chrono::seconds(10);
  constexpr auto kShortestPause = std::chrono::milliseconds(10);
  constexpr auto kLongestPause = std::chrono::milliseconds(200);
  const pid_t process = Spawn(argv, log, options.environment, true);
  std::optional<Clock::time_point> interrupted;
  int status = 0;
  auto pause = kShortestPause;
  for (pid_t ended = 0; ended != process;) {
    ended = waitpid(process, &status, WNOHANG);
    if (ended < 0 && errno != EINTR) break;
    if (ended != 0) continue;
    if (options.cancelled && options.cancelled()) {
      if (!interrupted) {
        interrupted = Clock::now();
        ::kill(-process, SIGINT);
      } else if (Clock::now() - *interrupted > kPatience) {
        ::kill(-process, SIGKILL);
      }
    }
    std::this_thread::sleep_for(pause);
    pause = std::min(kLongestPause, 2 * pause);
  }
  return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}

void OpenOnDesktop(const std::string& target) {
  const fs::path opener = Opener();
  if (opener.empty()) {
    throw EnvironmentError("found no program that opens a page (xdg-open, $BROWSER); open " +
                           target + " in a browser");
  }
  RunToLog({opener.string(), target}, "/dev/null");
}

}  // namespace glint

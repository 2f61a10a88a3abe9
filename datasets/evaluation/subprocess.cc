#include "datasets/evaluation/subprocess.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>

#include "pipeline/contract/errors.h"

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

pid_t Spawn(const std::vector<std::string>& argv, const fs::path& log) {
  std::vector<char*> pointers;
  for (const std::string& argument : argv) pointers.push_back(const_cast<char*>(argument.c_str()));
  pointers.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, 1, log.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0666);
  posix_spawn_file_actions_adddup2(&actions, 1, 2);
  pid_t process = 0;
  const int error =
      posix_spawn(&process, argv[0].c_str(), &actions, nullptr, pointers.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) {
    throw EnvironmentError(argv[0] + ": cannot be started: " + std::strerror(error));
  }
  return process;
}

}  // namespace

fs::path SiblingProgram(const std::string& name) {
  const fs::path program = fs::canonical("/proc/self/exe").parent_path() / name;
  if (!fs::exists(program)) {
    throw EnvironmentError(program.string() + ": no such program; build it first");
  }
  return program;
}

void RunToLog(const std::vector<std::string>& argv, const fs::path& log) {
  const pid_t process = Spawn(argv, log);
  int status = 0;
  while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
  const std::string how = WIFEXITED(status) ? "exit code " + std::to_string(WEXITSTATUS(status))
                                            : "signal " + std::to_string(WTERMSIG(status));
  throw ComputationError(argv[0] + " ended with " + how + "; see " + log.string() + ":\n" +
                         Tail(log));
}

}  // namespace glint
